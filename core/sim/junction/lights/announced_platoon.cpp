#include "sim/junction/lights/announced_platoon.h"

#include <algorithm>
#include <cmath>

#include "base/containers/index.h"
#include "base/simd/arithmetic.h"
#include "base/speed_thresholds.h"
#include "sim/clearing/arrival_forecast.h"
#include "sim/state/queries/desired_gap.h"
#include "sim/state/queries/gap.h"
#include "sim/state/queries/stopping_distance.h"
#include "v2v/platoon_place.h"

namespace stopline {

namespace {

bool leads_mini_platoon(const VehicleArrays& v, int slot) {
    if (v.has_v2v_channel) return v.v2v.rest[at(slot)].leads_mini_platoon;
    return v.has_platoon_limit && v.platoon.target_time_gap_s[at(slot)] > 0.0;
}

// Returns true if the vehicle belongs to the platoon of the vehicle ahead of it. For the first vehicle of a lane, the
// slot before it holds a copy of the vehicle ahead.
bool is_in_platoon_of_leader(const Model& model, const VehicleArrays& v, int slot) {
    const int policy = v.policy[at(slot)];
    if (model.driver_of(policy).is_human || leads_mini_platoon(v, slot)) return false;
    const double excess_m = net_gap_m(v, slot - 1, slot) - desired_gap_m(model, policy, v.speed_mps[at(slot)]);
    return is_close_enough(excess_m, false);
}

// Returns true if the vehicle can stop comfortably before the line.
bool can_stop(const Model& model, const VehicleArrays& v, int slot, double line_m) {
    const double room_m = line_m - v.position_m[at(slot)];
    const double deceleration_mps2 = model.driver_of(v.policy[at(slot)]).tables.stop.deceleration_mps2;
    return room_m >= 0.0 && can_stop_after_response(model, v, slot, room_m, deceleration_mps2);
}

}  // namespace

AnnouncedPlatoon announced_platoon(const Model& model, const State& state, int lane, double range_m) {
    const VehicleArrays& v = state.vehicles;
    const LaneBlock& block = state.blocks[at(lane)];
    const double line_m = model.graph.lanes[at(lane)].stop_line_m;
    int first = block.first;
    while (first < block.past_last() && !can_stop(model, v, first, line_m)) ++first;
    if (first == block.past_last() || line_m - v.position_m[at(first)] > range_m) return {};
    if (model.driver_of(v.policy[at(first)]).is_human) return {};

    AnnouncedPlatoon result;
    const bool has_leader = first > block.first || v.record[at(first)].leader_id >= 0;
    const bool starts = v.speed_mps[at(first)] < kStoppedSpeed_mps;
    result.can_wait = !starts && !(has_leader && is_in_platoon_of_leader(model, v, first));
    double passing_s = 0.0;    // time until the front of the present vehicle reaches the line
    double passing_mps = 0.0;  // its speed there
    int slot = first;
    do {
        const int policy = v.policy[at(slot)];
        const double limit_mps = state.plan.free_speed_mps(lane, policy);
        const double acceleration_mps2 = model.driver_of(policy).tables.cacc.acceleration_max_mps2;
        const double distance_m = line_m - v.position_m[at(slot)];
        double own_s = travel_time_s(distance_m, v.speed_mps[at(slot)], acceleration_mps2, limit_mps);
        if (slot != first) {
            const double gap_m = desired_gap_m(model, policy, passing_mps);
            own_s = std::max(own_s, passing_s + (static_cast<double>(v.length_m[at(slot - 1)]) + gap_m) / passing_mps);
        }
        passing_s = own_s;
        const double free_mps = std::sqrt(square(v.speed_mps[at(slot)]) + 2.0 * acceleration_mps2 * distance_m);
        passing_mps = std::max({std::min(free_mps, limit_mps), v.speed_mps[at(slot)], passing_mps, 1.0});
        ++slot;
    } while (slot < block.past_last() && is_in_platoon_of_leader(model, v, slot));
    const double rear_s = passing_s + static_cast<double>(v.length_m[at(slot - 1)]) / passing_mps;
    result.rear_tick = state.tick + static_cast<std::int64_t>(std::ceil(rear_s / model.step_s));
    return result;
}

}  // namespace stopline
