// A vehicle model compiled for the step function. Constants are combined, and curves are resampled to uniform grids, so
// that a look-up needs no search. The tables are made once from `PowertrainSettings`, are constant and shared by all
// runs.
#pragma once

#include <array>

#include "vehicle/powertrain_settings.h"

namespace stopline {

// `Number` is double for making the tables and for calculations with single vehicles. It is float for the kernels, the
// loops over vehicles (base/simd/narrowed.h).
template <class Number>
struct PowertrainTablesOf {
    static constexpr int kMaxGears = 8;
    // Sizes of uniform grids over engine speed, from 0 to the limiter
    static constexpr int kTorqueNodes = 32;
    static constexpr int kLagNodes = 16;

    Number length_m = 0.0;
    Number maximum_speed_mps = 0.0;  // speed limiter
    Number mass_kg = 0.0;            // kerb mass and load
    Number drag_Ns2pm2 = 0.0;        // 0.5 rho c_d A: air resistance divided by the square of the speed
    Number rolling_N = 0.0;          // m g r0
    Number rolling_Nspm = 0.0;       // m g r1
    Number inverse_mass_1pkg = 0.0;
    Number friction_mps2 = 0.0;  // mu g: friction limit of acceleration and deceleration
    Number idle_rpm = 0.0;
    Number launch_rpm = 0.0;  // 0: no clutch (electric car)
    Number limiter_rpm = 0.0;
    Number shift_up_part_rpm = 0.0;
    Number shift_up_full_rpm = 0.0;
    Number shift_down_rpm = 0.0;
    Number torque_interruption_s = 0.0;
    Number minimum_gear_time_s = 0.0;
    Number brake_lag_s = 0.0;
    Number rotating_mass_open = 1.0;  // value of rotating_mass with open clutch: only the wheels rotate
    Number efficiency = 1.0;
    Number gears = 1;
    // The clutch is open below 3/4 of a reference engine speed and closed from the reference speed on. The reference is
    // launch_rpm in first gear and idle_rpm in other gears. The degree of closing is factor x rpm - offset, limited to
    // 0 .. 1. Without a clutch the factor is 0 and the offset is -1, so the degree is always 1 (closed).
    Number closing_launch_1prpm = 0.0;
    Number closing_idle_1prpm = 0.0;
    Number closing_offset = -1.0;

    std::array<Number, kMaxGears> rpm_per_mps{};    // [gear] engine speed over vehicle speed
    std::array<Number, kMaxGears> mps_per_rpm{};    // [gear] inverse of rpm_per_mps
    std::array<Number, kMaxGears> rotating_mass{};  // [gear] effective mass (with rotating parts) over mass
    std::array<Number, kMaxGears> lag_factor{};

    Number torque_nodes_per_rpm = 0.0;
    std::array<Number, kTorqueNodes> full_load_Nm{};
    std::array<Number, kTorqueNodes> drag_Nm{};  // drag torque, <= 0
    Number lag_nodes_per_rpm = 0.0;
    std::array<Number, kLagNodes> lag_unloaded_s{};  // time constant of the torque at no load
    std::array<Number, kLagNodes> lag_loaded_s{};    // time constant of the torque at full load
};
using PowertrainTables = PowertrainTablesOf<double>;

// Compiles the settings. Throws InputError if they are unusable, such as without gears or without full-load curve.
PowertrainTables compile_powertrain(const PowertrainSettings& settings);

// Returns the gear of a vehicle that cruises at this speed: the highest gear in which the engine speed is at least 10 %
// above the downshift speed. 0 is the first gear.
int cruising_gear(const PowertrainTables& tables, double speed_mps);

// Returns the highest acceleration at a speed on a level road, m/s2, in the gear in which this acceleration is largest,
// and outside of gear changes. The result is below 0 above the highest speed of the vehicle.
double available_acceleration_mps2(const PowertrainTables& tables, double speed_mps);

// Returns the linear interpolation of a sampled curve, constant beyond its ends.
double interpolate(const SampledCurve& curve, double x);

}  // namespace stopline
