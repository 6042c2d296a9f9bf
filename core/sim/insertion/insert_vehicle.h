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
    bool behind_last = true;  // true: it becomes the last vehicle on the lane; false: position_m determines its place
};

// Inserts a vehicle and returns its slot. The caller must then set the position of the vehicle on its route, and call
// finish_insertion().
int insert_vehicle(const Model& model, State& state, const NewVehicle& vehicle);

// Initialises the sensors of an inserted vehicle and records its entry. The caller must have set the position of the
// vehicle on its route before.
void finish_insertion(const Model& model, State& state, int lane, int slot);

}  // namespace stopline
