// A queue of stopped vehicles on one lane, as the delay watch sees it. Owner: sim/congestion.
#pragma once

#include "sim/state/delay_log.h"

namespace stopline {

// Consecutive stopped vehicles of one lane. The first vehicle can wait for anything. Each other vehicle only waits for
// the vehicle directly ahead of it. All vehicles of a queue have the same delay cause.
//
// The slots are valid only in the step that attributes the delays, because vehicles change slots. The ids, lanes and
// causes stay valid.
struct StoppedQueue {
    int first = -1;  // slot of the first vehicle
    int count = 0;   // number of vehicles
    int lane = -1;
    int earliest_stop_tick = 0;  // tick at which the longest stop of a vehicle in the queue began

    int blocker = -1;       // slot of the vehicle that blocks the first vehicle; -1: none
    int blocker_id = -1;    // id of this vehicle; -1: none
    int blocker_lane = -1;  // lane of this vehicle; -1: none

    // The queue head: the vehicle at which the chain of waiting vehicles begins. It is the first vehicle of this queue,
    // or a vehicle of another queue if the first vehicle only waits behind a stopped leader on another lane.
    int head = -1;       // slot of the queue head
    int head_lane = -1;  // lane of the queue head
    // Slot of the last vehicle that is in a cycle of vehicles waiting for each other; -1: the cycle contains no vehicle
    // of this queue. The cycle contains all vehicles of the queue up to this one.
    int cycle_last = -1;
    int traversal = 0;  // number of the search that reached the queue first; 0: none yet

    // Cause that stops the first vehicle itself. DelayCause::none: the vehicle only waits behind a stopped leader, or
    // nothing stops the vehicle.
    DelayCause direct_cause = DelayCause::none;
    DelayCause cause = DelayCause::none;  // cause to which the delay of all vehicles is attributed

    int past_last() const { return first + count; }
    // Returns the slot of the queue head for the vehicle in `slot`. Each vehicle in a cycle is its own queue head. The
    // queue head of the vehicles behind the cycle is the vehicle in slot cycle_last.
    int head_of(int slot) const { return cycle_last < 0 ? head : slot < cycle_last ? slot : cycle_last; }
};

}  // namespace stopline
