// Braking and stopping distances in m, one function for each purpose. Positions are in m, speeds in m/s.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/containers/index.h"
#include "base/simd/arithmetic.h"
#include "driver/acceleration_laws.h"
#include "sim/state/model.h"
#include "sim/state/vehicles/vehicle_arrays.h"

namespace stopline {

// Returns the distance in which constant braking changes the speed from `from_mps` to `to_mps`. Returns 0 if `to_mps`
// is the higher speed. The reaction time is not included.
inline double braking_distance_m(double from_mps, double to_mps, double deceleration_mps2) {
    return 0.5 * std::max(square(from_mps) - square(to_mps), 0.0) / deceleration_mps2;
}

// Returns the braking distance of a comfortable stop, that is, with the deceleration `stop.deceleration` of the driver
// settings. The reaction time is not included.
inline double comfortable_braking_distance_m(const DriverPlan& driver, double speed_mps) {
    return 0.5 * square(speed_mps) / driver.tables.stop.deceleration_mps2;
}

// Returns the distance of a comfortable stop. In full dynamics the distance includes the effect of brake lag.
inline double reliable_stopping_distance_m(const Model& model, const DriverPlan& driver, double speed_mps) {
    return model.meso ? comfortable_braking_distance_m(driver, speed_mps)
                      : stopping_distance_m(driver.tables, speed_mps);
}

// Returns the highest speed from which a vehicle stops within `distance_m`, by reliable_stopping_distance_m().
// Precondition: `distance_m` is at least 0.
inline double reliably_stoppable_speed_mps(const Model& model, const DriverPlan& driver, double distance_m) {
    const double b = driver.tables.stop.deceleration_mps2;
    const double reaction_mps = model.meso ? 0.0 : b * kBrakingReaction_s;
    return std::sqrt(square(reaction_mps) + 2.0 * b * distance_m) - reaction_mps;
}

// Mesoscale mode: returns how vehicles of a policy brake before a stop line. The deceleration is that of the
// car-following model, but at most `stop.deceleration` of the driver settings.
inline FollowingBraking stop_line_braking(const Model& model, int policy) {
    FollowingBraking braking = model.following[at(policy)].braking();
    braking.deceleration_mps2 =
        std::min(braking.deceleration_mps2, model.driver_of(policy).tables.stop.deceleration_mps2);
    return braking;
}

// Returns the braking distance of an emergency stop. The reaction time is not included.
inline double emergency_braking_distance_m(const Model& model, double speed_mps) {
    return 0.5 * square(speed_mps) / model.common_driver().cacc.deceleration_emergency_mps2;
}

// Returns the distance of an emergency stop. In full dynamics, the vehicle first drives on for kBrakeResponse_s.
inline double emergency_stopping_distance_m(const Model& model, double speed_mps) {
    const double response_m = model.meso ? 0.0 : kBrakeResponse_s * speed_mps;
    return emergency_braking_distance_m(model, speed_mps) + response_m;
}

// Returns true if a vehicle can stop within `distance_m` with maximum braking.
inline bool can_stop_within(const Model& model, double speed_mps, double distance_m) {
    return emergency_stopping_distance_m(model, speed_mps) <= distance_m;
}

// Returns true if the vehicle can stop within `distance_m` if it brakes with `deceleration_mps2` after a response time.
// In the response time the vehicle keeps its present acceleration (if below 0: taken as 0), so the braking starts at a
// higher speed. The response time is the brake lag plus half the time that the requested acceleration needs, at the
// jerk limit, to fall to `-deceleration_mps2`. The requested acceleration can be higher than the present one while
// gears change or if the vehicle is too weak for the request.
inline bool can_stop_after_response(const Model& model, const VehicleArrays& v, int slot, double distance_m,
                                    double deceleration_mps2) {
    const double speed = v.speed_mps[at(slot)];
    const double lag_s = model.vehicles[at(v.type_of(at(slot)))].brake_lag_s;
    const double present_mps2 = std::max(static_cast<double>(v.acceleration_mps2[at(slot)]), 0.0);
    const double request_mps2 =
        v.has_powertrain() ? std::max(present_mps2, static_cast<double>(v.request_mps2[at(slot)])) : present_mps2;
    const CaccSettings& cacc = model.driver_of(v.policy[at(slot)]).tables.cacc;
    const double delay_s = lag_s + 0.5 * (request_mps2 + deceleration_mps2) / cacc.jerk_down_mps3;
    const double delay_m = (speed + 0.5 * present_mps2 * delay_s) * delay_s;
    const double room_m = distance_m - delay_m;
    return square(speed + present_mps2 * delay_s) <= 2.0 * deceleration_mps2 * room_m;
}

// Returns the distance to a conflict area within which right of way is decided: the distance of a comfortable stop plus
// a reserve.
inline double decision_distance_m(const DriverPlan& driver, double speed_mps) {
    constexpr double kReserve_s = 1.5;  // our choice, as the next one
    constexpr double kReserve_m = 3.0;
    return 0.5 * square(speed_mps) / driver.tables.stop.deceleration_mps2 + kReserve_s * speed_mps + kReserve_m;
}

inline constexpr double kLaneChangeReaction_s = 0.5;

// Returns the smallest distance to the stop line at which a vehicle can change lanes and then still stop comfortably.
inline double lane_change_stopping_distance_m(const DriverPlan& driver, double speed_mps) {
    return 0.5 * square(speed_mps) / driver.tables.stop.deceleration_mps2 + kLaneChangeReaction_s * speed_mps;
}

// Returns the speed whose lane_change_stopping_distance_m() is `distance_m`.
inline double lane_change_stopping_speed_mps(const DriverPlan& driver, double distance_m) {
    const double b = driver.tables.stop.deceleration_mps2;
    return std::sqrt(square(b * kLaneChangeReaction_s) + 2.0 * b * distance_m) - b * kLaneChangeReaction_s;
}

// Returns the gap that a vehicle needs to stop behind another vehicle that is inserted ahead of it. The standstill gap
// is included.
inline double insertion_stopping_distance_m(const DriverPlan& driver, double speed_mps, double standstill_gap_m) {
    constexpr double kReaction_s = 1.0;
    return speed_mps * kReaction_s + 0.5 * square(speed_mps) / driver.tables.cacc.deceleration_comfort_mps2 +
           standstill_gap_m;
}

// Returns the highest speed from which a vehicle inserted at `front_m` can stop comfortably before the stop line.
// Returns kUnlimitedSpeed_mps if there is no stop line ahead.
inline double max_stoppable_speed_mps(const Model& model, const DriverPlan& driver, int lane, double front_m) {
    const Lane& road = model.graph.lanes[at(lane)];
    if (road.signal_group < 0 || front_m > road.stop_line_m) return kUnlimitedSpeed_mps;
    const double room_m = std::max(road.stop_line_m - driver.tables.stop.margin_m - front_m, 0.0);
    return reliably_stoppable_speed_mps(model, driver, room_m);
}

}  // namespace stopline
