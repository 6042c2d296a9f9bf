// A vehicle model compiled for the step function: constants combined, curves resampled to uniform grids, so that a look-up
// is one multiplication and no search. Built once from `PowertrainSettings`; constant afterwards; shared by all runs.
#pragma once

#include <array>

#include "vehicle/powertrain_settings.h"

namespace stopline {

// Over double for closed forms and set-up, over float for the kernels (base/narrowed.h).
template <class Number>
struct PowertrainTablesOf {
    static constexpr int kMaxGears = 8;
    // Uniform grids over engine speed, from 0 to the limiter
    static constexpr int kTorqueNodes = 32;
    static constexpr int kLagNodes = 16;

    Number length_m = 0.0;
    Number mass_kg = 0.0;       // kerb mass and load
    Number drag_Ns2pm2 = 0.0;   // 0.5 rho c_d A: air resistance over speed squared
    Number rolling_N = 0.0;     // m g r0
    Number rolling_Nspm = 0.0;  // m g r1
    Number inverse_mass_1pkg = 0.0;
    Number friction_mps2 = 0.0;  // mu g, driving and braking
    Number idle_rpm = 0.0;
    Number launch_rpm = 0.0;  // 0: no clutch (electric)
    Number limiter_rpm = 0.0;
    Number shift_up_part_rpm = 0.0;
    Number shift_up_full_rpm = 0.0;
    Number shift_down_rpm = 0.0;
    Number torque_interruption_s = 0.0;
    Number minimum_gear_time_s = 0.0;
    Number brake_lag_s = 0.0;
    Number rotating_mass_open = 1.0;  // rotating-mass factor with the clutch open: the wheels' share
    Number efficiency = 1.0;
    Number gears = 1;
    // The clutch is open below 3/4 of launch (first gear) or idle speed and closed from there on, linear between:
    // closed = rpm x factor - offset, within 0 .. 1. Without a clutch the factor is 0 and the offset -1.
    Number closing_launch_1prpm = 0.0;
    Number closing_idle_1prpm = 0.0;
    Number closing_offset = -1.0;

    std::array<Number, kMaxGears> rpm_per_mps{};    // engine speed over vehicle speed, per gear
    std::array<Number, kMaxGears> mps_per_rpm{};    // its inverse
    std::array<Number, kMaxGears> rotating_mass{};  // effective over real mass, per gear
    std::array<Number, kMaxGears> lag_factor{};

    Number torque_nodes_per_rpm = 0.0;
    std::array<Number, kTorqueNodes> full_load_Nm{};
    std::array<Number, kTorqueNodes> drag_Nm{};  // <= 0
    Number lag_nodes_per_rpm = 0.0;
    std::array<Number, kLagNodes> lag_unloaded_s{};  // at no torque ...
    std::array<Number, kLagNodes> lag_loaded_s{};    // ... and at full load
};
using PowertrainTables = PowertrainTablesOf<double>;

// Throws InputError where the settings are not usable (gears missing, more than kMaxGears, curves empty).
PowertrainTables compile_powertrain(const PowertrainSettings& settings);

// The gear that a vehicle cruising at this speed is in: the highest that keeps the engine above the downshift speed.
int gear_for(const PowertrainTables& tables, double speed_mps);

// Linear interpolation of a sampled curve, constant beyond its ends.
double interpolate(const SampledCurve& curve, double x);

}  // namespace stopline
