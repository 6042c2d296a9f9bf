// The user's settings for the energy use of a vehicle: section `energy` of data/vehicles/*.yaml. SI units, except fuel
// rates in g/h and engine speeds in rpm. Energy is computed from finished steps (vehicle/energy_model.h). It never
// changes how vehicles move.
#pragma once

#include <string>
#include <vector>

#include "vehicle/sampled_curve.h"

namespace stopline {

struct EnergySettings {
    std::string source = "fuel";  // fuel: combustion engine | battery: electric motor

    // Combustion engine
    SampledCurve fuel_rate;        // [g/h] over engine power [W] from 0 W on
    double idle_fuel_g_per_h = 0;  // fuel rate at standstill
    // Driveline efficiency with which the data behind fuel_rate compute engine power from wheel power. 1: fuel_rate
    // belongs to the power of the engine itself.
    double map_efficiency = 1.0;
    double fuel_density_kg_per_m3 = 742.0;
    double co2_per_fuel = 3.168;  // mass of CO2 over mass of fuel (no unit)

    // Electric motor and battery
    std::vector<double> loss_rpm;        // grid of motor speeds, rising
    std::vector<double> loss_torque_Nm;  // grid of motor torques from 0 N m on, rising; applies to recuperation, too
    std::vector<double> loss_W;          // [rpm][torque] losses of motor and inverter; one row per motor speed
    double battery_V = 400.0;            // open-circuit voltage
    double battery_ohm = 0.1;            // internal resistance

    double auxiliaries_W = 0.0;  // constant power of auxiliaries, from the engine or from the battery

    bool operator==(const EnergySettings&) const = default;
};

}  // namespace stopline
