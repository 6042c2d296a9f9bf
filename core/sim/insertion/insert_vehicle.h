// Inserts one vehicle.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

struct NewVehicle {
    int lane = -1;
    double position_m = 0.0;  // position of the front, from the start of the lane
    double speed_mps = 0.0;
    double length_m = 0.0;
    int policy = 0;
    int route = -1;
    // True: the new vehicle becomes the last vehicle on the lane. False: position_m determines its place.
    bool behind_last = true;
};

// Returns the highest speed, at most `wanted_mps`, with which a new vehicle can enter at a net gap `gap_m` behind a
// leader. The gap then contains the desired gap of the policy at this speed, and the distance of comfortable braking to
// the speed of the leader. Returns -1 if the gap is too short even at the lower one of `wanted_mps` and `leader_mps`.
double safe_entry_speed_mps(const Model& model, int policy, double gap_m, double leader_mps, double wanted_mps);

// Inserts a vehicle and returns its slot. The caller must then put the vehicle on its route (adopt_lane_route() or
// enter_trip_edge()), and call finish_insertion().
int insert_vehicle(const Model& model, State& state, const NewVehicle& vehicle);

// Initialises the sensors of an inserted vehicle and records its entry. The caller must have put the vehicle on its
// route before.
void finish_insertion(const Model& model, State& state, int lane, int slot);

}  // namespace stopline
