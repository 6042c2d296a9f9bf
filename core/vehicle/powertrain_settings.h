// The user's settings of a vehicle (data/vehicles/*.yaml), in SI units unless the name has another unit. The settings
// do not change after loading. The step function reads the `PowertrainTables` made from them (powertrain_tables.h).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vehicle/energy_settings.h"
#include "vehicle/sampled_curve.h"

namespace stopline {

struct PowertrainSettings {
    std::string name;

    // Body
    double length_m = 5.15;
    double mass_kg = 1235.0;  // kerb mass
    double load_kg = 50.0;    // driver and luggage
    double drag_coefficient = 0.311;
    double frontal_area_m2 = 2.118;
    double rolling_r0 = 0.009;           // rolling resistance coefficient at standstill (no unit)
    double rolling_r1_s_per_m = 5.0e-5;  // increase of the coefficient per m/s
    double wheel_diameter_m = 0.606;
    double maximum_speed_mps = 500.0 / 3.6;  // speed limiter; the driver never wants to drive faster

    // Engine or motor
    SampledCurve full_load;  // maximum torque [N m] over engine speed [rpm]
    // Lowest torque [N m], <= 0, over engine speed [rpm]. For an engine: the torque without fuel supply. For an
    // electric motor: the torque at the limit of its recuperation.
    SampledCurve drag_torque;
    double idle_rpm = 798.0;  // 0 for an electric motor
    double limiter_rpm = 6500.0;

    // Transmission. An electric car has a single gear, no shifts and no clutch (launch_rpm 0)
    std::vector<double> gear_ratio;
    std::vector<double> rotating_mass_factor;  // [gear] effective mass (with rotating parts) over mass, >= 1
    double final_drive = 4.083;
    double driveline_efficiency = 0.92;
    double launch_rpm = 1500.0;  // engine speed that the slipping clutch or converter holds during the start
    // Engine speed of the upshift: the first value up to 50 % of the full-load torque, the second value from 90 % on,
    // and linear in between.
    double shift_up_part_load_rpm = 2000.0;
    double shift_up_full_load_rpm = 4500.0;
    double shift_down_rpm = 1100.0;
    double torque_interruption_s = 0.45;  // time without drive torque during a gear change
    double minimum_gear_time_s = 1.5;     // shortest time between gear changes; downshifts while braking do not wait

    // Time constant of the first-order lag of the torque: a map over engine speed and requested share of the full-load
    // torque, times a factor per gear
    std::vector<double> lag_rpm;           // grid of engine speeds, rising
    std::vector<double> lag_torque_share;  // grid of requested torque over full-load torque, 0 .. 1, rising
    std::vector<double> lag_drive_s;       // [rpm][share] time constant; one row per engine speed
    std::vector<double> lag_gear_factor;   // [gear]
    double brake_lag_s = 0.2;
    double brake_friction = 0.8;  // tyre-road friction coefficient (no unit) that limits braking and traction

    // Empty: there are no data for the energy use of the vehicle, and scenarios that measure it are refused.
    std::optional<EnergySettings> energy = {};

    bool operator==(const PowertrainSettings&) const = default;
};

}  // namespace stopline
