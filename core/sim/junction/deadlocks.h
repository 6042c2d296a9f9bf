// Deadlocks inside an intersection: stopped vehicles that wait for each other in a cycle. One of them goes first.
// Imported networks only.
#pragma once

#include "sim/state/model.h"
#include "sim/state/partition.h"
#include "sim/state/state.h"

namespace stopline {

// Returns the deadlock resolution that lets the vehicle in `first_slot` proceed and the vehicle in `second_slot` wait;
// nullptr: none.
DeadlockResolution* find_resolution(const State& state, Partition& part, int first_slot, int second_slot);

// Returns a deadlock resolution that lets the vehicle in `slot` proceed before any other vehicle; nullptr: none.
DeadlockResolution* find_resolution_for(const State& state, Partition& part, int slot);

// Finds the cycles of stopped vehicles of a partition that wait for each other. In each cycle one vehicle gets a
// deadlock resolution: among those that wait only for right of way, not for a vehicle in their path, the one that has
// waited longest, then the one with the lowest id. Call it when all yield stops of the step are known.
void resolve_deadlocks(const Model& model, const State& state, Partition& part);

}  // namespace stopline
