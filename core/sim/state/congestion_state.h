// The data of delay attribution and teleporting. Owner: sim/congestion.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/state/delay_log.h"
#include "sim/state/vehicles/vehicle_arrays.h"

namespace stopline {

// A teleported vehicle that waits for room to be reinserted.
struct TeleportTarget {
    int lane = -1;                   // lane on which the vehicle will be reinserted
    std::int64_t waiting_since = 0;  // tick since which the vehicle has waited for room on the lane
};

// The vehicle that blocked the first vehicle of a lane when the signal of the lane was last green.
struct LastBlocker {
    int vehicle = -1;       // id of the blocked vehicle
    int blocker = -1;       // id of the vehicle that blocked it
    int blocker_lane = -1;  // lane of the blocker
    int tick = 0;           // tick of the last observation of the blocker
};

// Working memory of delay attribution. The arrays indexed by slot are valid only in the step that attributed the
// delays, because vehicles change slots. Unless noted otherwise, only the elements of stopped vehicles are valid.
struct DelayWatch {
    std::vector<int> waits_for;  // [slot] slot of the blocker, the vehicle that this vehicle waits for; -1: none
    std::vector<DelayCause>
        direct_cause;                // [slot] cause that stops the vehicle directly; none: no cause except its leader
    std::vector<DelayCause> cause;   // [slot] cause to which the delay of the vehicle is attributed
    std::vector<int> queue_head;     // [slot] slot of the first vehicle of the queue in which the vehicle stands
    std::vector<int> lane;           // [slot] lane of the vehicle, also for moving vehicles
    std::vector<int> vehicle;        // [slot] id of the vehicle, also for moving vehicles
    std::vector<int> traversal;      // [slot] number of the chain in which find_causes() visited it; 0: not visited yet
    std::vector<int> path;           // slots of the chain of waiting vehicles that find_causes() follows at present
    std::vector<int> stopped_slots;  // slots of all stopped vehicles
    std::vector<LastBlocker> last_blockers;  // [lane]
    std::vector<int> open_episode;           // [lane * causes + cause] index of the open episode; -1: none
    std::vector<int> open_episodes;          // keys of all open episodes; key: lane * causes + cause
    std::vector<int> open_gridlocks;         // indices of the open gridlocks in DelayLog::gridlocks
};

struct CongestionState {
    LaneBlock teleporting;                         // slots of vehicles that are removed and not yet reinserted
    std::vector<TeleportTarget> teleport_targets;  // target of each vehicle in `teleporting`, in the order of slots
    std::int64_t missed_turns = 0;  // vehicles on trips that reached the end of a lane that does not allow their turn
    DelayLog delays;
    DelayWatch watch;
};

}  // namespace stopline
