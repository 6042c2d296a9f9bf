// What each stopped vehicle waits for.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Lists the stopped vehicles of a partition and updates the tick since which each vehicle has been stopped.
void find_stopped_vehicles(State& state, Partition& part);

// Finds the vehicle that each stopped vehicle of a partition waits for, and the direct cause. All partitions must have
// listed their stopped vehicles before.
void find_wait_reasons(const Model& model, const State& state, DelayWatch& watch, const Partition& part);

}  // namespace stopline
