// Finds the lanes with vehicles. Works on one partition, a group of whole intersections.
#pragma once

#include "sim/state/state.h"

namespace stopline {

// Lists the lanes of a partition that hold vehicles. Wakes a sleeping lane (QueueState) if its signal is
// green.
void find_occupied_lanes(const State& state, QueueState& queues, Partition& part);

}  // namespace stopline
