// Braking and stopping distances, one function for each purpose. Positions in m, speeds in m/s.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/containers/index.h"
#include "base/simd/arithmetic.h"
#include "driver/acceleration_laws.h"
#include "sim/state/model.h"
#include "sim/state/vehicles/vehicle_arrays.h"

namespace stopline {

// Returns the distance in which constant braking changes the speed, without reaction time; 0 if `to_mps` is higher.
inline double braking_distance_m(double from_mps, double to_mps, double deceleration_mps2) {
    return 0.5 * std::max(square(from_mps) - square(to_mps), 0.0) / deceleration_mps2;
}

// Returns the distance of a comfortable stop (stop.deceleration), without reaction time.
inline double comfortable_braking_distance_m(const Model& model, double speed_mps) {
    return 0.5 * square(speed_mps) / model.driver.stop.deceleration_mps2;
}

// Returns the distance of a comfortable stop. Full dynamics: including the lag of the brake.
inline double reliable_stopping_distance_m(const Model& model, double speed_mps) {
    return model.meso ? comfortable_braking_distance_m(model, speed_mps) : stopping_distance_m(model.driver, speed_mps);
}

// Returns the distance of an emergency stop, without reaction time.
inline double emergency_braking_distance_m(const Model& model, double speed_mps) {
    return 0.5 * square(speed_mps) / model.driver.cacc.deceleration_emergency_mps2;
}

// Returns the distance to a conflict area within which right of way is decided: a comfortable stop plus a reserve.
inline double decision_distance_m(const Model& model, double speed_mps) {
    return 0.5 * square(speed_mps) / model.driver.stop.deceleration_mps2 + 1.5 * speed_mps + 3.0;
}

// Returns the distance to the stop line that a lane change needs, so that the vehicle can still stop comfortably.
inline double lane_change_stopping_distance_m(const Model& model, double speed_mps) {
    constexpr double kReaction_s = 0.5;
    return 0.5 * square(speed_mps) / model.driver.stop.deceleration_mps2 + kReaction_s * speed_mps;
}

// Returns the distance in which a vehicle stops behind a vehicle that is inserted ahead, including its standstill gap.
inline double insertion_stopping_distance_m(const Model& model, double speed_mps, double standstill_gap_m) {
    constexpr double kReaction_s = 1.0;
    return speed_mps * kReaction_s + 0.5 * square(speed_mps) / model.driver.cacc.deceleration_comfort_mps2 +
           standstill_gap_m;
}

// Returns the highest speed from which a vehicle inserted at `front_m` stops comfortably before the stop line, or
// kUnlimitedSpeed_mps if there is no stop line ahead.
inline double max_stoppable_speed_mps(const Model& model, int lane, double front_m) {
    const Lane& road = model.graph.lanes[at(lane)];
    if (road.signal_group < 0 || front_m > road.stop_line_m) return kUnlimitedSpeed_mps;
    const double room_m = std::max(road.stop_line_m - model.driver.stop.margin_m - front_m, 0.0);
    return std::sqrt(2.0 * model.driver.stop.deceleration_mps2 * room_m);
}

}  // namespace stopline
