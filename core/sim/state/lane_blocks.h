// The memory of each lane's vehicles: adding, moving and removing vehicles in the slots of lanes.
//
// Functions that add a vehicle can change the slots of all vehicles. A sleeping lane (QueueState) holds slots, so these
// functions wake the lanes that they change.
#pragma once

#include <vector>

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

double shortest_vehicle_m(const Model& model);

// Sets up the blocks of all lanes before the first step.
void allocate_lane_blocks(const Model& model, State& state);

// Mesoscale mode: makes room for vehicles that are about to be inserted, [lane].
void reserve_blocks(State& state, const std::vector<int>& expected);

// Ensures that the next vehicle can be appended to a lane.
void ensure_free_slot(State& state, int lane);

// Ensures that the next vehicle can be appended to the teleported vehicles (mesoscale mode).
void ensure_teleport_slot(State& state);

// Appends a slot at the upstream end of a lane and returns it.
int append_slot(State& state, int lane);

// Adds a slot for a vehicle with its front at `front_m`, between the vehicles of a lane, and returns it. Detectors
// downstream of the front will record the vehicle.
int insert_slot(const Model& model, State& state, int lane, double front_m);

// Removes the first vehicle of a lane.
void remove_first(State& state, int lane);

// Moves the vehicle with index `from` of a lane to index `index` of another lane, with its front at `front_m`. Indices
// count from the first vehicle. Returns the new slot.
int move_to_lane(const Model& model, State& state, int lane, int from, int other, int index, double front_m);

}  // namespace stopline
