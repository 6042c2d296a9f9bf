#include "runs/driving/driving_csv.h"

#include <algorithm>

#include "base/containers/index.h"
#include "base/io/csv.h"
#include "base/units.h"

namespace stopline {

std::string energy_csv(const std::vector<PopulationDriving>& populations) {
    const auto exists = [](const PopulationDriving& p) { return p.driving.energy.exists; };
    if (std::none_of(populations.begin(), populations.end(), exists)) return {};
    CsvWriter csv({"population", "vehicle", "policy", "entered_s", "left_s", "distance_m", "stops", "idle_s", "fuel_g",
                   "co2_g", "energy_Wh", "driven_Wh", "overrun_Wh", "brake_Wh", "air_Wh", "rolling_Wh"});
    for (const PopulationDriving& p : populations) {
        for (const VehicleEnergy& vehicle : p.driving.energy.vehicles) {
            const auto in_Wh = [](double work_J) { return fixed(work_J / kSecondsPerHour, 3); };
            const StepWork& work = vehicle.work;
            csv.row({p.population, p.vehicle_names.of(vehicle.id), p.driving.energy.policy_names[at(vehicle.policy)],
                     fixed(vehicle.entered_s, 2), fixed(vehicle.left_s, 2), fixed(work.distance_m, 2),
                     std::to_string(vehicle.stops), fixed(vehicle.idle_s, 2),
                     vehicle.has_battery ? "" : fixed(vehicle.use.fuel_g, 4),
                     vehicle.has_battery ? "" : fixed(vehicle.co2_g, 3),
                     vehicle.has_battery ? in_Wh(vehicle.use.battery_J) : "", in_Wh(work.driven_J),
                     in_Wh(work.overrun_J), in_Wh(work.brake_J), in_Wh(work.air_J), in_Wh(work.rolling_J)});
        }
    }
    return csv.text();
}

std::string safety_distributions_csv(const std::vector<PopulationDriving>& populations) {
    const auto exists = [](const PopulationDriving& p) { return p.driving.safety.exists; };
    if (std::none_of(populations.begin(), populations.end(), exists)) return {};
    CsvWriter csv({"population", "measure", "from", "to", "time_s", "share_percent"});
    for (const PopulationDriving& p : populations) {
        for (std::size_t k = 0; k < kSafetyMeasures; ++k) {
            const SafetyAxis& axis = kSafetyAxes[k];
            const SafetyDistribution& distribution = p.driving.safety.distributions[k];
            for (std::size_t bin = 0; bin < distribution.samples().size(); ++bin) {
                const auto samples = static_cast<double>(distribution.samples()[bin]);
                if (samples == 0.0) continue;
                const double from = axis.from + axis.width * static_cast<double>(bin);
                csv.row({p.population, std::string(axis.name), fixed(from, 2), fixed(from + axis.width, 2),
                         fixed(samples * p.driving.safety.sample_s, 1),
                         fixed(100.0 * samples / static_cast<double>(distribution.count()), 4)});
            }
        }
    }
    return csv.text();
}

}  // namespace stopline
