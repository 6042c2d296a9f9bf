#include "runs/driving/energy_csv.h"

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
            const auto Wh = [](double work_J) { return fixed(work_J / kSecondsPerHour, 3); };
            const StepWork& work = vehicle.work;
            csv.row({p.population, std::to_string(vehicle.id), p.driving.energy.policy_names[at(vehicle.policy)],
                     fixed(vehicle.entered_s, 2), fixed(vehicle.left_s, 2), fixed(work.distance_m, 2),
                     std::to_string(vehicle.stops), fixed(vehicle.idle_s, 2),
                     vehicle.has_battery ? "" : fixed(vehicle.use.fuel_g, 4),
                     vehicle.has_battery ? "" : fixed(vehicle.co2_g, 3),
                     vehicle.has_battery ? Wh(vehicle.use.battery_J) : "", Wh(work.driven_J), Wh(work.overrun_J),
                     Wh(work.brake_J), Wh(work.air_J), Wh(work.rolling_J)});
        }
    }
    return csv.text();
}

}  // namespace stopline
