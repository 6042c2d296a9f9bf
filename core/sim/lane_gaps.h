// What is around a place on a lane, for those that want to change to it, and what they need there.
#pragma once

#include "sim/model.h"
#include "sim/state.h"

namespace stopline {

// One of the two neighbours that a vehicle would have: net gap, speed and policy.
struct Neighbour {
    int slot = -1;  // -1: none
    double gap_m = 1e6;
    double speed_mps = 0.0;
    int policy = 0;
};

struct Around {
    int place = 0;  // of the vehicle, were it on the lane, counted from the lane's first
    Neighbour ahead;
    Neighbour behind;
};

// Around a vehicle whose front would be at `front_m` of a lane. Beyond the lane's ends it is looked along `route` (-1: along all ways on,
// as far as their vehicles reach back) and along all lanes that lead there.
Around around(const Model& model, const State& state, int lane, double front_m, double length_m, int route);

// Where the front of a vehicle on a lane would be on the lane beside.
inline double beside_m(const State& state, int lane, double front_m, int other) {
    return front_m + state.plan.beside(lane).begin_m - state.plan.beside(other).begin_m;
}

// The gap that a vehicle needs to follow another one: a share of what its policy keeps at its speed, but not less than at standstill, and
// what braking to the speed of the other takes if that brakes as hard (the secure gap of SUMO's lane changer, with the gap of the policy).
double needed_gap_m(const Model& model, int policy, double speed_mps, double ahead_mps, double share);

}  // namespace stopline
