// The driver of the reference engine in full dynamics: the requested acceleration. The equations are those of the
// comments in core/driver/acceleration_laws.h.
#pragma once

#include "base/speed_thresholds.h"
#include "reference/human.h"
#include "reference/powertrain.h"
#include "reference/sensors.h"
#include "reference/world.h"

namespace stopline::reference_engine {

struct DriverModel {
    DriverSettings settings;
    GridCurve profile_mps2;  // free driving: acceleration over speed
    GridCurve power_mps2;    // lower bound of profile_mps2 for desired speeds above profile_end_mps
    double profile_end_mps = 0.0;
};

inline DriverModel make_driver_model(const DriverSettings& settings, const VehicleModel& vehicle) {
    constexpr double kRounding = 1.001;
    const FreeDriveSettings& free = settings.free_drive;
    DriverModel driver;
    driver.settings = settings;
    driver.profile_mps2 = GridCurve(std::max(free.speed_mps.back(), 1.0), 32);
    for (std::size_t node = 0; node < 32; ++node) {
        driver.profile_mps2.values()[node] =
            interpolated(free.speed_mps, free.acceleration_mps2, driver.profile_mps2.x_of(node));
    }
    driver.power_mps2 = power_curve(vehicle, free.power_share);
    const double limit_mps = free.profile_limit_mps > 0.0 ? free.profile_limit_mps : free.speed_mps.back();
    driver.profile_end_mps = kRounding * settings.cacc.catch_up_factor * limit_mps;
    return driver;
}

inline double squared(double x) { return x * x; }

inline double free_acceleration_mps2(const DriverModel& d, double speed_mps, double desired_mps) {
    double profile_mps2 = d.profile_mps2.at(speed_mps);
    if (desired_mps > d.profile_end_mps) profile_mps2 = std::max(profile_mps2, d.power_mps2.at(speed_mps));
    return std::min(profile_mps2, d.settings.free_drive.speed_gain_1ps * (desired_mps - speed_mps));
}

// Returns the acceleration before a lower speed limit, along v^2 = end^2 + 2 b distance.
inline double slow_down_mps2(const DriverModel& d, double speed_mps, double end_mps, double distance_m) {
    const double b = d.settings.free_drive.deceleration_mps2;
    const double allowed_mps = std::sqrt(squared(end_mps) + 2.0 * b * std::max(distance_m, 0.0));
    return allowed_mps - speed_mps - b * speed_mps / std::max(allowed_mps, 1.0);
}

inline constexpr double kLanding_s = 0.5;

// Returns the acceleration for a stop after a distance, along v_s = -b tau + sqrt((b tau)^2 + 2 b distance).
inline double stop_after_mps2(const DriverModel& d, double speed_mps, double distance_m) {
    constexpr double kGain_1ps = 1.5;
    const double b = d.settings.stop.deceleration_mps2;
    const double bt = b * kLanding_s;
    const double curve_mps = std::sqrt(bt * bt + 2.0 * b * std::max(distance_m, 0.0)) - bt;
    return (distance_m > 0.0 ? 0.0 : -b) + kGain_1ps * (curve_mps - speed_mps) - b * speed_mps / (curve_mps + bt);
}

// Returns the acceleration for a stop at a line: along the curve, but between the deceleration that is needed now and
// the one that is needed after kLanding_s without braking.
inline double stop_at_line_mps2(const DriverModel& d, double speed_mps, double distance_m) {
    const double b = d.settings.stop.deceleration_mps2;
    const double needed_mps2 = 0.5 * squared(speed_mps) / std::max(distance_m, 0.1);
    const double later_mps2 = 0.5 * squared(speed_mps) / std::max(distance_m - speed_mps * kLanding_s, 0.1);
    double mps2 = std::max(stop_after_mps2(d, speed_mps, distance_m), -std::max(b, later_mps2));
    if (needed_mps2 > b) mps2 = std::min(mps2, -needed_mps2);
    return mps2;
}

// Returns the acceleration for a stop behind the leader; infinity if the leader is not about to stop.
inline double stop_behind_mps2(const DriverModel& d, double speed_mps, double standstill_gap_m, const View& p) {
    constexpr double kStopping_mps = 5.0;
    constexpr double kBraking_mps2 = 0.2;
    const double leader_mps = std::max(speed_mps - p.closing_mps, 0.0);
    const bool is_stopping = leader_mps < kStopping_mps && p.request_mps2 <= -kBraking_mps2 * std::min(leader_mps, 1.0);
    if (!is_stopping) return std::numeric_limits<double>::infinity();
    const double b = d.settings.stop.deceleration_mps2;
    const double leader_stop_m = leader_mps * leader_mps / (2.0 * b) + leader_mps * kLanding_s;
    const double delayed_m = d.settings.cacc.radar_delay_s * p.closing_mps;
    return stop_after_mps2(d, speed_mps, p.gap_m - delayed_m - standstill_gap_m + leader_stop_m);
}

// Returns the constant request u that brings the own acceleration close to that of the leader. It solves the equation
// w u = a_p(t + th) - (1 - w) a with w = 1 - exp(-th / tau) by least squares, for three values of th.
inline double predictive_request_mps2(const CaccSettings& c, const Vehicle& v, const View& p) {
    double numerator = 0.0;
    double denominator = 0.0;
    for (int k = 0; k < 3; ++k) {
        const double th_s = c.prediction_start_s + 0.5 * k * (c.prediction_end_s - c.prediction_start_s);
        const double own = std::exp(-th_s / v.lag_s);
        const double leader_mps2 =
            p.request_mps2 + (p.acceleration_mps2 - p.request_mps2) * std::exp(-(th_s + c.v2v_delay_s) * p.rate_1ps);
        numerator += (1.0 - own) * (leader_mps2 - own * v.acceleration_mps2);
        denominator += squared(1.0 - own);
    }
    return std::clamp(numerator / denominator, -c.deceleration_emergency_mps2, c.acceleration_max_mps2);
}

// Returns the acceleration of the spacing controller. `desired` is the gap of the spacing law. `growth_m` is the part
// of this gap beyond the standstill gap.
inline double follow_mps2(const CaccSettings& c, const Vehicle& v, const LawGap& desired, double growth_m,
                          const View& p, double dt) {
    constexpr double kFilterRoom_s = 0.3;
    constexpr double kHardBraking_mps2 = 2.0;
    const double error_m = p.gap_m - desired.gap_m;
    const double error_rate_mps = -p.closing_mps - desired.slope_s * v.acceleration_mps2;
    const double feedback_mps2 = c.feedback_kp_1ps2 * error_m + c.feedback_kd_1ps * error_rate_mps;
    const double forward_mps2 = p.acceleration_mps2 + v.lag_s * p.rate_1ps * (p.request_mps2 - p.acceleration_mps2);
    const double filtered_mps2 =
        v.request_mps2 + (feedback_mps2 + forward_mps2 - v.request_mps2) * dt / (desired.slope_s + 0.5 * dt);
    const double distance_mps2 =
        c.feedback_kp_1ps2 * error_m - c.feedback_kd_1ps * p.closing_mps + predictive_request_mps2(c, v, p);
    const double room_m = growth_m + std::min(error_m, 0.0);
    double result_mps2 = filtered_mps2;
    if (desired.slope_s <= 0.0) {
        result_mps2 = distance_mps2;
    } else if (room_m < kFilterRoom_s * v.speed_mps && p.request_mps2 < -kHardBraking_mps2) {
        result_mps2 = std::min(distance_mps2, filtered_mps2);
    }
    return std::clamp(result_mps2, -c.deceleration_comfort_mps2, c.acceleration_max_mps2);
}

// Returns the emergency braking; infinity while the needed deceleration is below the threshold.
inline double emergency_mps2(const CaccSettings& c, double speed_mps, const View& p) {
    constexpr double kMargin = 1.15;
    const double closing_mps = std::max(p.closing_mps, 0.0);
    const double room_m = std::max(p.gap_m - c.radar_delay_s * p.closing_mps - c.emergency_gap_m, 0.05);
    const double leader_b =
        std::clamp(-std::min(p.acceleration_mps2, p.request_mps2), 0.01, c.deceleration_emergency_mps2);
    const double leader_mps = std::max(speed_mps - p.closing_mps, 0.0);
    const bool meets_moving_leader = 2.0 * room_m * leader_b < leader_mps * closing_mps;
    const double needed_mps2 = meets_moving_leader
                                   ? leader_b + squared(closing_mps) / (2.0 * room_m)
                                   : squared(speed_mps) / (2.0 * (room_m + squared(leader_mps) / (2.0 * leader_b)));
    if (needed_mps2 <= c.emergency_threshold_mps2) return std::numeric_limits<double>::infinity();
    return -std::min(kMargin * needed_mps2, c.deceleration_emergency_mps2);
}

// Returns the braking to the safe speed, v_safe^2 = v_p^2 + 2 b room; infinity if the vehicle is not faster. At the
// safe speed, the vehicle can still stop if the leader brakes with the maximum deceleration.
inline double keep_room_mps2(const CaccSettings& c, double speed_mps, double growth_m, const View& p) {
    constexpr double kGain_1ps = 2.0;
    constexpr double kBrakeReserve_s = 0.3;
    constexpr double kGrowthShare = 0.5;
    constexpr double kMinReserve_s = 0.15;
    const double b = c.deceleration_emergency_mps2;
    const double delay_m = (c.radar_delay_s + kBrakeReserve_s) * std::max(p.closing_mps, 0.0);
    const double reserve_m = std::max(std::min(kBrakeReserve_s * speed_mps, kGrowthShare * growth_m),
                                      growth_m > 0.0 ? kMinReserve_s * speed_mps : 0.0);
    const double room_m = std::max(p.gap_m - delay_m - reserve_m - c.emergency_gap_m, 0.05);
    const double leader_mps = std::max(speed_mps - p.closing_mps, 0.0);
    const double safe_mps = std::sqrt(squared(leader_mps) + 2.0 * b * room_m);
    if (speed_mps <= safe_mps) return std::numeric_limits<double>::infinity();
    const double along_mps2 = (leader_mps * std::min(p.acceleration_mps2, 0.0) - b * p.closing_mps) / safe_mps;
    return std::max(along_mps2 + kGain_1ps * (safe_mps - speed_mps), -b);
}

// Returns the same for a driver without V2V. Its reserve is the distance that it drives until its brakes respond, even
// if its policy asks for a shorter gap.
inline double keep_response_room_mps2(const CaccSettings& c, double speed_mps, const View& p) {
    constexpr double kGain_1ps = 2.0;
    constexpr double kBrakeReserve_s = 0.3;
    const double b = c.deceleration_emergency_mps2;
    const double response_s = c.radar_delay_s + kBrakeReserve_s;
    const double room_m = p.gap_m - response_s * (speed_mps + std::max(p.closing_mps, 0.0)) - c.emergency_gap_m;
    const double leader_mps = std::max(speed_mps - p.closing_mps, 0.0);
    const double safe_mps = std::sqrt(std::max(squared(leader_mps) + 2.0 * b * room_m, 0.0));
    if (speed_mps <= safe_mps) return std::numeric_limits<double>::infinity();
    const double along_mps2 =
        (leader_mps * std::min(p.acceleration_mps2, 0.0) - b * p.closing_mps) / std::max(safe_mps, 1.0);
    return std::max(along_mps2 + kGain_1ps * (safe_mps - speed_mps), -b);
}

// The request of a vehicle at the end of a step, and its mean over the step. The powertrain gets the mean.
struct DriverRequest {
    double request_mps2 = 0.0;
    double mean_mps2 = 0.0;
    bool is_emergency = false;
    bool is_slowing_down = false;
};

// Returns the braking for a hidden leader: a vehicle beyond the leader that stays on the own route.
inline double hidden_leader_mps2(const DriverModel& d, double speed_mps, double standstill_gap_m, double growth_m,
                                 const View& p) {
    return std::min({emergency_mps2(d.settings.cacc, speed_mps, p),
                     keep_room_mps2(d.settings.cacc, speed_mps, growth_m, p),
                     stop_behind_mps2(d, speed_mps, standstill_gap_m, p)});
}

// Returns the request for the lowest acceleration of all laws, with limited jerk.
inline DriverRequest smooth_request(const CaccSettings& c, double lowest_mps2, double dt, const Vehicle& v) {
    constexpr double kStart_mps2 = 0.01;
    constexpr double kHold_mps2 = -0.3;
    const bool is_held = v.speed_mps <= kBrakeHoldSpeed_mps;
    const double smooth_mps2 =
        std::clamp(lowest_mps2, v.request_mps2 - c.jerk_down_mps3 * dt, v.request_mps2 + c.jerk_up_mps3 * dt);
    DriverRequest result;
    result.request_mps2 = std::max(smooth_mps2, is_held ? 0.0 : -c.deceleration_emergency_mps2);
    result.mean_mps2 =
        is_held && result.request_mps2 <= kStart_mps2 ? kHold_mps2 : 0.5 * (v.request_mps2 + result.request_mps2);
    return result;
}

// The conditions on a lane that the driver obeys besides its leader.
struct RoadView {
    double limit_mps = 0.0;
    double to_next_limit_m = 0.0;   // distance to the place where Vehicle::end_speed_mps applies
    double demand_mps2 = kNoLimit;  // highest acceleration that stops, gaps and hidden leaders allow
};

// Returns the requested acceleration of an automated vehicle. Clears Vehicle::is_platoon_leader when the acceleration
// for following no longer exceeds that of free driving.
inline DriverRequest plan_request(const DriverModel& d, const GapPolicy& policy, const RoadView& road, const View& p,
                                  double dt, Vehicle& v) {
    const CaccSettings& c = d.settings.cacc;
    const double speed_mps = v.speed_mps;
    // The request takes effect at the end of the step. So the desired gap is that of the speed at the end of the step.
    const LawGap desired = law_gap(policy, std::max(speed_mps + v.acceleration_mps2 * dt, 0.0));
    const double standstill_gap_m = policy.settings.standstill_gap_m;
    const double growth_m = std::max(desired.gap_m - standstill_gap_m, 0.0);

    const bool sees_leader = p.gap_m < c.radar_range_m;
    const double free_mps2 =
        free_acceleration_mps2(d, speed_mps, sees_leader ? c.catch_up_factor * road.limit_mps : road.limit_mps);
    const double follow = follow_mps2(c, v, desired, growth_m, p, dt);
    v.is_platoon_leader = v.is_platoon_leader && follow > free_mps2;
    const double catch_up_mps2 =
        std::min(d.settings.free_drive.speed_gain_1ps * (c.catch_up_factor * road.limit_mps - speed_mps),
                 c.acceleration_max_mps2);

    double lowest_mps2 = std::min(v.is_platoon_leader ? free_mps2 : catch_up_mps2, follow);
    double slow_mps2 = kNoLimit;
    if (v.end_speed_mps < kNoLimit) slow_mps2 = slow_down_mps2(d, speed_mps, v.end_speed_mps, road.to_next_limit_m);
    const bool is_slowing_down = slow_mps2 < lowest_mps2;
    lowest_mps2 = std::min(lowest_mps2, slow_mps2);
    const double urgent_mps2 = std::min(emergency_mps2(c, speed_mps, p), keep_room_mps2(c, speed_mps, growth_m, p));
    const bool is_emergency = urgent_mps2 < lowest_mps2;
    lowest_mps2 =
        std::min({lowest_mps2, urgent_mps2, stop_behind_mps2(d, speed_mps, standstill_gap_m, p), road.demand_mps2});
    DriverRequest result = smooth_request(c, lowest_mps2, dt, v);
    result.is_emergency = is_emergency;
    result.is_slowing_down = is_slowing_down;
    return result;
}

// Returns the requested acceleration of a human driver: the intelligent driver model without V2V. `interaction` is the
// reaction to the vehicles ahead. A platoon leader starts with the start-up profile. `exact`: the radar view, for the
// braking that avoids a collision. The driver keeps the distance that it drives until its brakes respond.
inline DriverRequest plan_human_request(const DriverModel& d, const RoadView& road, const View& exact,
                                        double interaction, double dt, Vehicle& v) {
    const CaccSettings& c = d.settings.cacc;
    const double highest_mps2 = std::min(d.settings.human.idm.acceleration_mps2, c.acceleration_max_mps2);
    const double speed_mps = v.speed_mps;
    const double follow = interaction > 0.0 ? highest_mps2 * (1.0 - interaction) : kNoLimit;
    const double free_mps2 = free_acceleration_mps2(d, speed_mps, road.limit_mps);
    v.is_platoon_leader = v.is_platoon_leader && follow > free_mps2;
    double lowest_mps2 =
        v.is_platoon_leader ? free_mps2 : highest_mps2 * (1.0 - idm_free_term(speed_mps, road.limit_mps) - interaction);
    if (v.end_speed_mps < kNoLimit)
        lowest_mps2 = std::min(lowest_mps2, slow_down_mps2(d, speed_mps, v.end_speed_mps, road.to_next_limit_m));
    const double evasive_mps2 =
        std::min(emergency_mps2(c, speed_mps, exact), keep_response_room_mps2(c, speed_mps, exact));
    lowest_mps2 = std::min({lowest_mps2, evasive_mps2, road.demand_mps2});
    if (v.waits_to_start) lowest_mps2 = std::min(lowest_mps2, 0.0);
    return smooth_request(c, lowest_mps2, dt, v);
}

}  // namespace stopline::reference_engine
