// The lanes with vehicles.
#pragma once

#include "sim/state/state.h"

namespace stopline {

// Lists the lanes of a partition that hold vehicles, and wakes sleeping lanes whose signal is green.
void find_occupied_lanes(const State& state, QueueState& queues, Partition& part);

}  // namespace stopline
