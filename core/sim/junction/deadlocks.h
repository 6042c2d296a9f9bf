// Deadlocks inside an intersection: stopped vehicles that wait for each other in a cycle. A deadlock resolution lets
// one of them go first.
#pragma once

#include "sim/state/partition.h"
#include "sim/state/state.h"

namespace stopline {

// Returns the deadlock resolution that lets the vehicle in `first_slot` proceed and the vehicle in `second_slot` wait;
// nullptr: none.
DeadlockResolution* find_resolution(const State& state, Partition& part, int first_slot, int second_slot);

// Returns a deadlock resolution that lets the vehicle in `slot` proceed, whichever other vehicle must wait; nullptr:
// none.
DeadlockResolution* find_resolution_for(const State& state, Partition& part, int slot);

// Finds cycles of stopped vehicles in a partition, in which each vehicle waits for the next one (its blocker). A
// vehicle of the cycle has a free path if its blocker has not reached the conflict area of the two vehicles yet. In
// each cycle, adds a deadlock resolution that lets one vehicle with a free path proceed: the one that has waited
// longest, or after equally long waits the one with the lowest id. Call this function when all yield stops (YieldStop)
// of the step are known.
void resolve_deadlocks(const State& state, Partition& part);

}  // namespace stopline
