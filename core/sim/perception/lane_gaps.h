// Finds the lead and lag gaps at a position on a lane, and the gaps that a lane change requires.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// A vehicle that would be the leader or the follower after a lane change.
struct Neighbour {
    int slot = -1;       // -1: none
    double gap_m = 1e6;  // net gap
    double speed_mps = 0.0;
    int policy = 0;
};

// The leader and follower of a vehicle at a position on a lane, and its place among the vehicles there.
struct LaneNeighbours {
    int index = 0;  // place that the vehicle would have on the lane, counted from the first vehicle
    Neighbour leader;
    Neighbour follower;
};

// Returns the neighbours of a vehicle of `length_m` whose front would be at `front_m` on a lane. Beyond the lane's end
// the search follows `route`; with -1 it checks the last vehicle of each next lane. Upstream it covers all lanes that
// lead to the lane.
LaneNeighbours neighbours_at(const Model& model, const State& state, int lane, double front_m, double length_m,
                             int route);

// Returns the position on the adjacent lane `other` that lies beside `front_m` of `lane`.
inline double adjacent_position_m(const State& state, int lane, double front_m, int other) {
    return front_m + state.plan.adjacent(lane).start_offset_m - state.plan.adjacent(other).start_offset_m;
}

// Returns the net gap in m that a vehicle needs behind a leader after a lane change. It is `share` of the policy's gap
// at `speed_mps`, but at least the standstill gap, plus the distance to brake to the leader's speed `ahead_mps`. This
// is the secure gap of SUMO's lane changer, with the gap of the policy.
double required_gap_m(const Model& model, int policy, double speed_mps, double ahead_mps, double share);

}  // namespace stopline
