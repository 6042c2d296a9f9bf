// The data of delay attribution and teleporting. Owner: sim/congestion.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/state/delay_log.h"
#include "sim/state/stopped_queue.h"
#include "sim/state/vehicles/vehicle_arrays.h"

namespace stopline {

// The lane on which a teleported vehicle will be reinserted, and the start of its wait for room there.
struct TeleportTarget {
    int lane = -1;                        // lane on which the vehicle will be reinserted
    std::int64_t waiting_since_tick = 0;  // tick at which the wait for room on this lane began
};

// The vehicle that blocked the first vehicle of a lane during the previous green of the lane's signal.
struct LastBlocker {
    int vehicle = -1;       // id of the blocked vehicle
    int blocker = -1;       // id of the vehicle that blocked `vehicle`
    int blocker_lane = -1;  // lane of the blocker
    int tick = 0;           // latest tick at which the blocker was observed
};

// The memory of the delay watch for one lane.
struct LaneWatch {
    LastBlocker last_blocker;
    // Latest tick at which vehicles ahead blocked the way of the first vehicle of a queue on this lane; 0: none.
    int last_blocked_tick = 0;
    int front_id = -1;      // id of the first vehicle of the foremost queue on this lane; -1: no queue so far
    int front_tick = 0;     // tick since which this vehicle has been the first one
    int open_episode = -1;  // index in DelayWatch::open_episodes of an open episode on this lane; -1: none
};

// A period of delay that is not over. The open episodes of a lane form a linked list.
struct OpenEpisode {
    int episode = -1;  // index in DelayLog::episodes
    int next = -1;     // index in DelayWatch::open_episodes of the next open episode on the same lane; -1: none
};

// Memory of the delay watch. The stopped vehicles are in the lists of the partitions (Partition::stopped_queues).
struct DelayWatch {
    std::vector<LaneWatch> lanes;            // [lane]
    std::vector<OpenEpisode> open_episodes;  // in the order in which they began
    std::vector<int> open_gridlocks;         // indices of the open gridlocks in DelayLog::gridlocks
    std::vector<StoppedQueue*> path;         // queues in the chain that find_causes() follows at present
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
