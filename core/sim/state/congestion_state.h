// The data of delay attribution and teleporting. Owner: sim/congestion.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/state/delay_log.h"
#include "sim/state/vehicles/vehicle_arrays.h"

namespace stopline {

// The lane on which a teleported vehicle will be reinserted, and the start of its wait for room there.
struct TeleportTarget {
    int lane = -1;                   // lane on which the vehicle will be reinserted
    std::int64_t waiting_since = 0;  // tick at which the wait for room on this lane began
};

// The vehicle that blocked the first vehicle of a lane during the previous green of the lane's signal.
struct LastBlocker {
    int vehicle = -1;       // id of the blocked vehicle
    int blocker = -1;       // id of the vehicle that blocked `vehicle`
    int blocker_lane = -1;  // lane of the blocker
    int tick = 0;           // latest tick at which the blocker was observed
};

// Working memory of delay attribution. The arrays indexed by slot are valid only in the step that attributed the
// delays, because vehicles change slots. Their elements are set only for stopped vehicles (slower than 0.1 m/s), except
// where a comment includes moving vehicles.
struct DelayWatch {
    std::vector<int> waits_for;  // [slot] slot of the vehicle that blocks this vehicle; -1: none
    // [slot] cause that stops the vehicle itself. DelayCause::none: the vehicle only waits behind a stopped leader, or
    // nothing stops the vehicle.
    std::vector<DelayCause> direct_cause;
    std::vector<DelayCause> cause;  // [slot] cause to which the delay of the vehicle is attributed
    std::vector<int> queue_head;    // [slot] slot of the first vehicle of the queue to which the vehicle belongs
    std::vector<int> lane;          // [slot] lane of the vehicle, also for moving vehicles
    std::vector<int> vehicle;       // [slot] id of the vehicle, also for moving vehicles
    // [slot] number of the chain that contains the vehicle; 0: none yet. A chain leads from a waiting vehicle to its
    // blocker, to the blocker of the blocker, and so on. find_causes() numbers the chains from 1.
    std::vector<int> traversal;
    std::vector<int> path;                   // slots of the vehicles in the chain that find_causes() follows at present
    std::vector<int> stopped_slots;          // slots of all stopped vehicles
    std::vector<LastBlocker> last_blockers;  // [lane]
    // [lane] latest tick at which vehicles ahead blocked the way of the first vehicle of a queue on this lane; 0: none
    std::vector<std::int64_t> last_blocked_tick;
    // [key] index of the open episode in DelayLog::episodes; -1: none. key = lane * number of causes + cause
    std::vector<int> open_episode;
    std::vector<int> open_episodes;   // keys of all open episodes
    std::vector<int> open_gridlocks;  // indices of the open gridlocks in DelayLog::gridlocks
};

struct CongestionState {
    LaneBlock teleporting;                         // slots of vehicles that were removed and are not reinserted yet
    std::vector<TeleportTarget> teleport_targets;  // target of each vehicle in `teleporting`, in the same order
    // Number of missed turns: a vehicle on a trip has reached an intersection on a lane that does not allow the next
    // turn of the trip.
    std::int64_t missed_turns = 0;
    DelayLog delays;
    DelayWatch watch;
};

}  // namespace stopline
