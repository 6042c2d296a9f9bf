// The standing queues that the kernels of the mesoscale mode skip. Owner: sim/mesoscale.
#pragma once

#include <cstdint>
#include <vector>

namespace stopline {

// Consecutive vehicles of one lane that are at rest at the start of a step only because of their leader. The first
// vehicle of the queue may start in the step. The vehicles behind it stay at rest, because nothing to which they react
// has changed. Indices are counted from the first vehicle of the lane.
struct StandingQueue {
    int first = 0;  // index of the first vehicle of the queue
    int end = 0;    // index after the last vehicle of the queue
    // The latest tick at which a vehicle was inserted into the lane, or at which a vehicle of the queue other than the
    // first one had to stop for a reason other than its leader.
    std::int64_t last_external_tick = -1;
    int released = 0;  // vehicles with a lower index may have moved in the previous step after a StartMessage
};

struct QueueState {
    std::vector<StandingQueue> standing;  // [lane]
    // [lane] signal group whose green wakes the sleeping lane; -1: the lane is awake. The first vehicle of a sleeping
    // lane is at rest before its red signal. No decisions are made for the lane until the signal is green, or until a
    // vehicle joins or leaves the lane.
    std::vector<int> sleeps_until_green;
};

}  // namespace stopline
