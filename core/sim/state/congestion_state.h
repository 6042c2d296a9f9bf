// State of delay attribution and teleporting. Owner: sim/congestion.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/state/delay_log.h"
#include "sim/state/vehicles/vehicle_arrays.h"

namespace stopline {

// A teleported vehicle that waits for room to be reinserted.
struct TeleportTarget {
    int lane = -1;                   // lane of reinsertion
    std::int64_t waiting_since = 0;  // tick from which the vehicle has waited for room on this lane
};

// The vehicle that blocked the first vehicle of a lane when its signal was last green.
struct LastBlocker {
    int vehicle = -1;       // id of the first vehicle
    int blocker = -1;       // id of the vehicle that it waited for
    int blocker_lane = -1;  // lane of the blocker
    int tick = 0;
};

// Scratch memory and open episodes of delay attribution. Entries of stopped vehicles are valid in the step of the last
// observation only, since vehicles change slots.
struct DelayWatch {
    std::vector<int> waits_for;              // [slot] slot of the blocker, which may crawl; -1: none
    std::vector<DelayCause> direct_cause;    // [slot] reason of the wait; none: the vehicle follows its leader
    std::vector<DelayCause> cause;           // [slot] cause to which the delay is attributed
    std::vector<int> queue_head;             // [slot] first vehicle of the queue, which the cause stops
    std::vector<int> lane;                   // [slot] all vehicles
    std::vector<int> vehicle;                // [slot] id, all vehicles
    std::vector<int> traversal;              // [slot] number of the traversal that visited the vehicle; 0: none
    std::vector<int> path;                   // slots visited by the present traversal
    std::vector<int> stopped_slots;          // all stopped vehicles
    std::vector<LastBlocker> last_blockers;  // [lane]
    std::vector<int> open_episode;           // [lane * causes + cause] index of the open episode; -1: none
    std::vector<int> open_episodes;          // keys lane * causes + cause of all open episodes
    std::vector<int> open_gridlocks;         // indices into DelayLog::gridlocks
};

struct CongestionState {
    LaneBlock teleporting;                         // block of the teleported vehicles ...
    std::vector<TeleportTarget> teleport_targets;  // ... and the target of each
    std::int64_t missed_turns = 0;  // vehicles on trips that reached the stop line in a lane without their turn
    DelayLog delays;
    DelayWatch watch;
};

}  // namespace stopline
