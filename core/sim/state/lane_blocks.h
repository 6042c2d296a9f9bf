// Adds, moves and removes vehicles in the slots of the lanes. A slot is the index of a vehicle in the vehicle arrays.
//
// Adding a vehicle to a lane can shift the vehicles of other lanes to other slots. The decisions at a stop line refer
// to slots (StopLines::stop_slot). A sleeping lane, whose first vehicle rests before a red signal (QueueState), keeps
// the decisions of an earlier step. Therefore each lane whose vehicles are shifted is woken, and its decisions are made
// again.
#pragma once

#include <vector>

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Returns the length of the shortest vehicle that can occur in the run, m.
double shortest_vehicle_m(const Model& model);

// Sets up the blocks of all lanes before the first step.
void allocate_lane_blocks(const Model& model, State& state);

// Mesoscale mode: enlarges the blocks of all lanes before many vehicles are inserted. `expected`: [lane] number of
// vehicles that the block must hold. Does nothing in full dynamics.
void reserve_blocks(State& state, const std::vector<int>& expected);

// Ensures that a lane has a free slot after its last vehicle, and wakes the lane.
void ensure_free_slot(State& state, int lane);

// Adds a speed target for a vehicle on a lane of a partition, for the present step.
void add_speed_target(State& state, Partition& part, int lane, const SpeedTarget& target);
// Removes the speed targets of the previous step from the lanes of a partition.
void clear_speed_targets(State& state, Partition& part);

// Makes a free slot in the block of teleported vehicles if the block has none. In full dynamics the block cannot grow,
// so it can still be full after the call.
void ensure_teleport_slot(State& state);

// Mesoscale mode: lowers the speed limit of a vehicle on `lane` to the maximum speed of the vehicle. Must be called
// after a vehicle has been copied to a slot of another lane.
void limit_to_maximum_speed(State& state, int lane, int slot);

// Adds a slot for a new last vehicle of a lane and returns the slot.
int append_slot(State& state, int lane);

// Adds a slot to a lane for a vehicle whose front is at `front_m`: behind the vehicles further downstream and ahead of
// the other vehicles. Returns the slot. Only detectors downstream of `front_m` will record the vehicle.
int insert_slot(const Model& model, State& state, int lane, double front_m);

// Removes the first vehicle of a lane.
void remove_first(State& state, int lane);

// Moves a vehicle from index `from` on `lane` to index `index` on the lane `other`, where its front is at `front_m`.
// Indices count from the first vehicle of a lane. Returns the new slot.
int move_to_lane(const Model& model, State& state, int lane, int from, int other, int index, double front_m);

}  // namespace stopline
