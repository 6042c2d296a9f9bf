// Finds the lanes with vehicles. Works on one partition, a group of whole intersections.
#pragma once

#include "sim/state/state.h"

namespace stopline {

// Lists the lanes of a partition that hold vehicles (Partition::occupied). Also makes lists with only those occupied
// lanes that are awake. A lane sleeps while its first vehicle rests before a red signal
// (QueueState::sleeps_until_green). This function wakes the lane if the signal is green.
void find_occupied_lanes(const State& state, QueueState& queues, Partition& part);

}  // namespace stopline
