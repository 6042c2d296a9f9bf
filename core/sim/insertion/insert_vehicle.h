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

// Inserts a vehicle and returns its slot. The caller must then put the vehicle on its route (adopt_lane_route() or
// enter_trip_edge()), and call finish_insertion().
int insert_vehicle(const Model& model, State& state, const NewVehicle& vehicle);

// Initialises the sensors of an inserted vehicle and records its entry. The caller must have put the vehicle on its
// route before.
void finish_insertion(const Model& model, State& state, int lane, int slot);

}  // namespace stopline
