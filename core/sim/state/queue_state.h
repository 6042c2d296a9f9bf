// Standing queues that the mesoscale mode leaves out of its kernels. Owner: sim/mesoscale.
#pragma once

#include <cstdint>
#include <vector>

namespace stopline {

// Consecutive vehicles of a lane that stood in the last step for no other reason than their leader. All but the first
// stay at rest in this step, because nothing that they react to has changed. Indices count from the lane's first
// vehicle.
struct StandingQueue {
    int first = 0;
    int end = 0;
    // Last tick at which something other than its leader stopped one of them (except the first), or at which a vehicle
    // was inserted into the lane.
    std::int64_t last_external_tick = -1;
    int released = 0;  // vehicles before this index received the start message in the last step
};

struct QueueState {
    std::vector<StandingQueue> standing;  // [lane]
    // [lane] signal group of a sleeping lane, -1: awake. The first vehicle of a sleeping lane rests before its red
    // signal; nothing is decided on the lane until the signal is green or a vehicle is added.
    std::vector<int> sleeps_until_green;
};

}  // namespace stopline
