// Deadlocks inside an intersection: stopped vehicles that wait for each other in a cycle. A deadlock resolution lets
// one of them go first.
#pragma once

#include "sim/state/partition.h"
#include "sim/state/state.h"

namespace stopline {

// Returns the deadlock resolution that lets the vehicle in `first_slot` proceed and the vehicle in `second_slot` wait;
// nullptr: none.
DeadlockResolution* find_resolution(const State& state, Partition& part, int first_slot, int second_slot);

// Returns a deadlock resolution that lets the vehicle in `slot` proceed, no matter which vehicle waits for it; nullptr:
// none.
DeadlockResolution* find_resolution_for(const State& state, Partition& part, int slot);

// Finds cycles of stopped vehicles in a partition, in which each vehicle waits for the next one (its blocker). In each
// cycle, adds a deadlock resolution for one vehicle that waits only for right of way: the blocker of this vehicle has
// not reached the conflict area of the two vehicles yet. If several vehicles of the cycle wait only for right of way,
// the vehicle that has waited longest proceeds; after equally long waits, the vehicle with the lowest id. Call this
// function when all yield stops of the step are known.
void resolve_deadlocks(const State& state, Partition& part);

}  // namespace stopline
