// Inserts one vehicle.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

struct NewVehicle {
    int lane = -1;
    double position_m = 0.0;  // front
    double speed_mps = 0.0;
    double length_m = 0.0;
    int policy = 0;
    int route = -1;
    bool behind_last = true;  // upstream of all vehicles of the lane; false: anywhere on the lane
};

// Inserts a vehicle and returns its slot. Its place on the route is not set yet.
int insert_vehicle(const Model& model, State& state, const NewVehicle& vehicle);

// Initialises the sensors and records the entry. Call it after the route has been set.
void finish_insertion(const Model& model, State& state, int lane, int slot);

}  // namespace stopline
