#include "sim/perception/lane_gaps.h"

#include <algorithm>

#include "base/containers/index.h"
#include "sim/state/queries/desired_gap.h"
#include "sim/state/queries/gap.h"
#include "sim/state/queries/stopping_distance.h"

namespace stopline {

namespace {

constexpr double kLookAhead_m = 150.0;

Neighbour neighbour(const VehicleArrays& v, int slot, double gap_m) {
    return {slot, gap_m, v.speed_mps[at(slot)], v.policy[at(slot)]};
}

// Returns the leader beyond the end of the lane: the nearest vehicle on `route`, or on any next lane if `route` is -1.
Neighbour leader_beyond_lane(const State& state, int lane, double front_m, int route) {
    const VehicleArrays& v = state.vehicles;
    if (route >= 0) {
        const LeaderAhead leader = leader_ahead(state, lane, front_m, RoutePosition{route}, kLookAhead_m);
        return neighbour_beyond_lane(v, leader, front_m);
    }
    Neighbour nearest;
    for (const int next : state.plan.next(lane)) {
        const LaneBlock& block = state.blocks[at(next)];
        if (block.count == 0) continue;
        const double gap_m = state.plan.lane(lane).length_m + rear_m(v, block.last()) - front_m;
        if (gap_m < nearest.gap_m) nearest = neighbour(v, block.last(), gap_m);
    }
    return nearest;
}

// Returns the nearest vehicle that approaches the lane from upstream. Its gap is measured to `rear_at_m`, a position on
// the lane.
Neighbour follower_upstream(const Model& model, const State& state, int lane, double rear_at_m) {
    const VehicleArrays& v = state.vehicles;
    Neighbour nearest;
    const auto keep_nearest = [&](int slot, double gap_m) {
        if (gap_m < nearest.gap_m) nearest = neighbour(v, slot, gap_m);
    };
    for (const int connection : model.connections_to.of(lane)) {
        const LanePlan& connection_plan = state.plan.lane(connection);
        const LaneBlock& inner = state.blocks[at(connection)];
        if (inner.count > 0) {
            keep_nearest(inner.first, connection_plan.length_m - v.position_m[at(inner.first)] + rear_at_m);
            continue;
        }
        const LaneBlock& origin_block = state.blocks[at(connection_plan.origin)];
        for (int slot = origin_block.first; slot < origin_block.past_last(); ++slot) {
            if (v.next_lane[at(slot)] != connection) continue;
            keep_nearest(slot, state.plan.lane(connection_plan.origin).length_m - v.position_m[at(slot)] +
                                   connection_plan.length_m + rear_at_m);
            break;
        }
    }
    return nearest;
}

}  // namespace

Neighbour neighbour_beyond_lane(const VehicleArrays& v, const LeaderAhead& leader, double front_m) {
    if (leader.slot < 0) return {};
    return neighbour(v, leader.slot, leader.lane_start_m + rear_m(v, leader.slot) - front_m);
}

int vehicles_ahead(const State& state, int lane, double front_m) {
    const LaneBlock& block = state.blocks[at(lane)];
    const double* const first = state.vehicles.position_m.data() + block.first;
    const double* const behind =
        std::partition_point(first, first + block.count, [=](double position_m) { return position_m >= front_m; });
    return static_cast<int>(behind - first);
}

LaneNeighbours neighbours_at(const Model& model, const State& state, int lane, double front_m, double length_m,
                             int route) {
    const VehicleArrays& v = state.vehicles;
    const LaneBlock& block = state.blocks[at(lane)];
    LaneNeighbours found;
    found.index = vehicles_ahead(state, lane, front_m);
    const int slot = block.first + found.index;
    found.leader = found.index == 0 ? leader_beyond_lane(state, lane, front_m, route)
                                    : neighbour(v, slot - 1, rear_m(v, slot - 1) - front_m);
    found.follower = found.index == block.count ? follower_upstream(model, state, lane, front_m - length_m)
                                                : neighbour(v, slot, front_m - length_m - v.position_m[at(slot)]);
    return found;
}

double required_gap_m(const Model& model, int policy, double speed_mps, double ahead_mps, double share) {
    // In full dynamics the radar and the brake respond late, so each vehicle of a platoon brakes harder than its
    // leader. The gap must therefore be so long that the vehicle behind the gap needs only gentle braking.
    constexpr double kGentleBraking_mps2 = 2.0;
    const double b_mps2 = model.meso ? model.following[at(policy)].braking().deceleration_mps2 : kGentleBraking_mps2;
    const double delay_m = model.meso ? 0.0 : kBrakeResponse_s * std::max(speed_mps - ahead_mps, 0.0);
    const double braking_m = braking_distance_m(speed_mps, ahead_mps, b_mps2) + delay_m;
    return std::max(share * desired_gap_m(model, policy, speed_mps), kMinLaneChangeGap_m) + braking_m;
}

}  // namespace stopline
