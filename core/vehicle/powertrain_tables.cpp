#include "vehicle/powertrain_tables.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "base/input_error.h"
#include "base/simd/arithmetic.h"
#include "base/units.h"

namespace stopline {

namespace {

void require(bool condition, const PowertrainSettings& settings, const char* message) {
    if (!condition) throw InputError(fmt::format("vehicle '{}': {}", settings.name, message));
}

void check(const PowertrainSettings& s) {
    require(!s.gear_ratio.empty(), s, "at least one gear ratio is needed");
    require(s.gear_ratio.size() <= static_cast<std::size_t>(PowertrainTables::kMaxGears), s,
            "at most 8 gears are allowed");
    require(s.rotating_mass_factor.size() == s.gear_ratio.size(), s, "one rotating mass factor per gear is needed");
    require(s.lag_gear_factor.size() == s.gear_ratio.size(), s, "one lag factor per gear is needed");
    require(!s.full_load.x.empty() && s.full_load.x.size() == s.full_load.y.size(), s,
            "the full-load curve is incomplete");
    require(s.drag_torque.x.size() == s.drag_torque.y.size(), s, "the drag-torque curve is incomplete");
    require(s.lag_drive_s.size() == s.lag_rpm.size() * s.lag_torque_share.size() && !s.lag_drive_s.empty(), s,
            "the lag map needs one value per engine speed and torque share");
    require(s.limiter_rpm > s.idle_rpm, s, "the limiter speed must be above the idle speed");
}

// Returns the time constant from the lag map by bilinear interpolation. Beyond the edges of the map, the values at the
// edges apply.
double lag_at(const PowertrainSettings& s, double rpm, double share) {
    const auto columns = s.lag_torque_share.size();
    SampledCurve over_rpm{s.lag_rpm, {}};
    for (std::size_t row = 0; row < s.lag_rpm.size(); ++row) {
        const auto begin = s.lag_drive_s.begin() + static_cast<std::ptrdiff_t>(row * columns);
        const SampledCurve over_share{s.lag_torque_share, {begin, begin + static_cast<std::ptrdiff_t>(columns)}};
        over_rpm.y.push_back(interpolate(over_share, share));
    }
    return interpolate(over_rpm, rpm);
}

}  // namespace

double interpolate(const SampledCurve& curve, double x) {
    const auto upper = std::upper_bound(curve.x.begin(), curve.x.end(), x);
    if (upper == curve.x.begin()) return curve.y.front();
    if (upper == curve.x.end()) return curve.y.back();
    const auto k = static_cast<std::size_t>(upper - curve.x.begin());
    const double share = (x - curve.x[k - 1]) / (curve.x[k] - curve.x[k - 1]);
    return curve.y[k - 1] + share * (curve.y[k] - curve.y[k - 1]);
}

int cruising_gear(const PowertrainTables& t, double speed_mps) {
    int gear = static_cast<int>(t.gears) - 1;
    while (gear > 0 && speed_mps * t.rpm_per_mps[static_cast<std::size_t>(gear)] < 1.1 * t.shift_down_rpm) --gear;
    return gear;
}

double available_acceleration_mps2(const PowertrainTables& t, double speed_mps) {
    const double resistance_N = t.rolling_N + t.rolling_Nspm * speed_mps + t.drag_Ns2pm2 * square(speed_mps);
    double highest_mps2 = -resistance_N * t.inverse_mass_1pkg;
    for (std::size_t gear = 0; gear < static_cast<std::size_t>(t.gears); ++gear) {
        const double locked_rpm = speed_mps * t.rpm_per_mps[gear];
        if (locked_rpm > t.limiter_rpm || (gear > 0 && locked_rpm < t.idle_rpm)) continue;
        const double rpm = gear == 0 ? std::max(locked_rpm, t.launch_rpm) : locked_rpm;
        const double torque_Nm = interpolate_on_grid(t.full_load_Nm, rpm * t.torque_nodes_per_rpm);
        const double force_N = torque_Nm * t.rpm_per_mps[gear] * kRadpsPerRpm * t.efficiency - resistance_N;
        highest_mps2 = std::max(highest_mps2, force_N * t.inverse_mass_1pkg / t.rotating_mass[gear]);
    }
    return std::min(highest_mps2, t.friction_mps2);
}

PowertrainTables compile_powertrain(const PowertrainSettings& s) {
    check(s);
    PowertrainTables t;
    const double radius_m = 0.5 * s.wheel_diameter_m;
    t.length_m = s.length_m;
    t.maximum_speed_mps = s.maximum_speed_mps;
    t.mass_kg = s.mass_kg + s.load_kg;
    t.drag_Ns2pm2 = 0.5 * kAirDensity_kgpm3 * s.drag_coefficient * s.frontal_area_m2;
    t.rolling_N = t.mass_kg * kGravity_mps2 * s.rolling_r0;
    t.rolling_Nspm = t.mass_kg * kGravity_mps2 * s.rolling_r1_s_per_m;
    t.inverse_mass_1pkg = 1.0 / t.mass_kg;
    t.friction_mps2 = s.brake_friction * kGravity_mps2;
    t.idle_rpm = s.idle_rpm;
    t.launch_rpm = s.launch_rpm;
    t.limiter_rpm = s.limiter_rpm;
    t.shift_up_part_rpm = s.shift_up_part_load_rpm;
    t.shift_up_full_rpm = s.shift_up_full_load_rpm;
    t.shift_down_rpm = s.shift_down_rpm;
    t.torque_interruption_s = s.torque_interruption_s;
    t.minimum_gear_time_s = s.minimum_gear_time_s;
    t.brake_lag_s = s.brake_lag_s;
    t.rotating_mass_open = *std::min_element(s.rotating_mass_factor.begin(), s.rotating_mass_factor.end());
    t.efficiency = s.driveline_efficiency;
    if (s.launch_rpm > 0.0) {
        t.closing_launch_1prpm = 4.0 / s.launch_rpm;
        t.closing_idle_1prpm = 4.0 / std::max(s.idle_rpm, 1.0);
        t.closing_offset = 3.0;
    }
    t.gears = static_cast<double>(s.gear_ratio.size());
    for (std::size_t g = 0; g < static_cast<std::size_t>(PowertrainTables::kMaxGears); ++g) {
        // Entries beyond the highest gear repeat its values.
        const std::size_t gear = std::min(g, s.gear_ratio.size() - 1);
        const double ratio = s.gear_ratio[gear] * s.final_drive;
        t.rpm_per_mps[g] = ratio / radius_m / kRadpsPerRpm;
        t.mps_per_rpm[g] = 1.0 / t.rpm_per_mps[g];
        t.rotating_mass[g] = s.rotating_mass_factor[gear];
        t.lag_factor[g] = s.lag_gear_factor[gear];
    }
    t.torque_nodes_per_rpm = (PowertrainTables::kTorqueNodes - 1) / s.limiter_rpm;
    for (std::size_t node = 0; node < t.full_load_Nm.size(); ++node) {
        const double rpm = static_cast<double>(node) / t.torque_nodes_per_rpm;
        t.full_load_Nm[node] = interpolate(s.full_load, rpm);
        t.drag_Nm[node] = s.drag_torque.x.empty() ? 0.0 : std::min(0.0, interpolate(s.drag_torque, rpm));
    }
    t.lag_nodes_per_rpm = (PowertrainTables::kLagNodes - 1) / s.limiter_rpm;
    for (std::size_t node = 0; node < t.lag_loaded_s.size(); ++node) {
        const double rpm = static_cast<double>(node) / t.lag_nodes_per_rpm;
        t.lag_unloaded_s[node] = lag_at(s, rpm, 0.0);
        t.lag_loaded_s[node] = lag_at(s, rpm, 1.0);
    }
    return t;
}

}  // namespace stopline
