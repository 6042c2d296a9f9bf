// The standing queues that the kernels of the mesoscale mode skip. Owner: sim/mesoscale.
#pragma once

#include <cstdint>

#include "base/simd/huge_page_allocator.h"

namespace stopline {

// Consecutive vehicles of one lane that are at rest at the start of a step. The first vehicle of the queue may start in
// the step. Each vehicle behind it is held only by its leader and stays at rest in the step. Exception: vehicles that
// receive a start message (StartMessage in partition.h) may start. Indices count from the first vehicle of the lane.
struct StandingQueue {
    int first = 0;  // index of the first vehicle of the queue
    int end = 0;    // index after the last vehicle of the queue
    // Latest tick at which something other than a leader may have acted on the vehicles behind the first one: an
    // insertion, a lane change, a speed target, a stop line, a yield stop or the reaction time of a human driver at
    // its start.
    int last_external_tick = -1;
    // Index after the last vehicle that may have moved in the previous step because of a start message. This vehicle is
    // the follower of the last receiver of the message. 0: there was no message.
    int released = 0;
};

struct QueueState {
    LargeArray<StandingQueue> standing;  // [lane]
    // [lane] signal group whose green wakes the sleeping lane; -1: the lane is awake. The first vehicle of a sleeping
    // lane is at rest before its red signal. Until the signal is green, or until a vehicle joins or leaves the lane, no
    // leader is searched for this vehicle, and the decisions at the stop line stay as they are.
    LargeArray<int> sleeps_until_green;
};

}  // namespace stopline
