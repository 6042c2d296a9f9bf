// Fuel, CO2 and electric energy of a run (measure.energy).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/nan.h"
#include "measure/zones.h"
#include "vehicle/energy_model.h"

namespace stopline {

// The whole way of a vehicle through the network.
struct VehicleEnergy {
    int id = 0;
    int policy = 0;  // index in Model::policies
    bool has_battery = false;
    double entered_s = 0.0;
    double left_s = kNan;  // NaN: in the network at the end of the run
    int stops = 0;         // stops, including a standstill at entry; a further stop counts after walking speed (5 km/h)
    double idle_s = 0.0;   // time as a stopped vehicle
    double fuel_l = 0.0;
    double co2_g = 0.0;
    EnergyUse use;
    StepWork work;
};

// Sums over the vehicles with an engine, or over those with a battery.
struct EnergySums {
    int vehicles = 0;
    double distance_km = 0.0;
    double amount = 0.0;  // fuel [g] or electric energy [Wh]
    int stops = 0;

    double per_vehicle() const { return vehicles > 0 ? amount / vehicles : kNan; }
    double per_km() const { return distance_km > 0.0 ? amount / distance_km : kNan; }
    double per_stop() const { return stops > 0 ? amount / stops : kNan; }
};

// Sums over the vehicles that leave the network in the measured window, or over all vehicles of a single light. Each
// counts with its whole way.
struct EnergyTotals {
    EnergySums fuel;
    EnergySums battery;
    double fuel_l = 0.0;
    double co2_g = 0.0;
    int vehicles = 0;
    int stops = 0;
    double idle_s = 0.0;
};

struct EnergyResult {
    std::vector<VehicleEnergy> vehicles;    // by id
    std::vector<std::string> policy_names;  // [policy]
    EnergyTotals totals;                    // of the measured window
    StepWork work;                          // of all vehicles in the whole run
    bool is_estimate = false;               // mesoscale mode
    double interval_s = 0.0;                // interval of the series
    std::vector<double> fuel_g_per_s;       // [interval] fuel rate of all vehicles
    std::vector<double> battery_W;          // [interval] battery power of all vehicles
    bool exists = false;                    // measure.energy is on

    // Returns the part of the work of engines and motors that the balance of a run in full dynamics misses, %. NaN for
    // estimates, whose balance closes by construction.
    double residual_percent() const {
        return !exists || is_estimate || work.driven_J <= 0.0 ? kNan : 100.0 * work.residual_J() / work.driven_J;
    }
};

// Returns the sums over the vehicles that leave the network in the window; without a window, over all vehicles.
EnergyTotals energy_totals(const std::vector<VehicleEnergy>& vehicles, const std::optional<TimeWindow>& window);

}  // namespace stopline
