// Finds the lanes with vehicles. Works on one partition, a group of whole intersections.
#pragma once

#include "sim/state/state.h"

namespace stopline {

// Lists the lanes of a partition that hold vehicles (Partition::occupied), and in further lists only the awake lanes
// with vehicles. A lane sleeps while its first vehicle rests before a red signal (QueueState::sleeps_until_green). This
// function wakes the lane if the signal is green.
void find_occupied_lanes(const State& state, QueueState& queues, Partition& part);

}  // namespace stopline
