// Finds the lead gap and the lag gap at a position on a lane. Computes the gaps that a lane change requires.
#pragma once

#include "sim/perception/look_ahead.h"
#include "sim/state/model.h"
#include "sim/state/no_leader.h"
#include "sim/state/state.h"

namespace stopline {

// A vehicle that would be the leader or the follower after a lane change.
struct Neighbour {
    int slot = -1;               // -1: there is no such vehicle
    double gap_m = kNoLeader_m;  // net gap
    double speed_mps = 0.0;
    int policy = 0;
};

// The leader and the follower that a vehicle would have at a position on a lane.
struct LaneNeighbours {
    int index = 0;  // number of vehicles on the lane that would be ahead of the vehicle
    Neighbour leader;
    Neighbour follower;
};

// Returns the leader and the follower that a vehicle of length `length_m` would have with its front at `front_m` on
// `lane`. If no vehicle of the lane would be ahead, the leader is searched further along `route`, which begins on the
// lane. If `route` is -1, the nearest of the last vehicles on all next lanes is the leader. If no vehicle of the lane
// would be behind, the follower is searched on the connections to the lane and on the lanes from which these
// connections come.
LaneNeighbours neighbours_at(const Model& model, const State& state, int lane, double front_m, double length_m,
                             int route);

// Returns the leader beyond the end of a lane as a neighbour of a vehicle that has its front at `front_m` on this lane.
Neighbour neighbour_beyond_lane(const VehicleArrays& vehicles, const LeaderAhead& leader, double front_m);

// Returns how many vehicles of a lane have their front at `front_m` or further downstream.
int vehicles_ahead(const State& state, int lane, double front_m);

// Returns the position on the adjacent lane `other` that lies beside `front_m` of `lane`.
inline double adjacent_position_m(const State& state, int lane, double front_m, int other) {
    return front_m + state.plan.adjacent(lane).start_offset_m - state.plan.adjacent(other).start_offset_m;
}

inline constexpr double kMinLaneChangeGap_m = 1.0;  // smallest lead gap and lag gap, even at standstill
// Returns the net gap in m that a vehicle needs behind its leader after a lane change. The gap is the sum of two parts.
// The first part is the spacing policy's gap at `speed_mps` times `share`, but at least kMinLaneChangeGap_m. The second
// part is the distance in which the vehicle brakes to the leader's speed `ahead_mps`. In full dynamics, this includes
// the distance that the vehicle drives before radar and brakes respond.
// SUMO's lane changer has the same formula for its secure gap, but with another gap in the first part.
double required_gap_m(const Model& model, int policy, double speed_mps, double ahead_mps, double share);

}  // namespace stopline
