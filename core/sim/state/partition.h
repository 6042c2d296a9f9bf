// The unit of parallel work in a step: the lanes of some whole intersections, with their working memory and reports.
// All partitions together hold the lanes in a fixed order. The order does not depend on the number of partitions. The
// reports are merged in this order, so the merged reports do not depend on the number of partitions either.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/containers/bitset.h"
#include "base/containers/index_buffer.h"
#include "base/containers/sparse_lists.h"
#include "sim/state/delay_log.h"
#include "sim/state/events.h"
#include "sim/state/gap_requests.h"
#include "sim/state/junction_state.h"
#include "sim/state/speed_target.h"
#include "sim/state/stopped_queue.h"
#include "sim/state/vehicles/full_group.h"
#include "sim/state/vehicles/lane_group.h"

namespace stopline {

// The permission to pass a blocker that has been stopped inside an intersection for a long time.
struct BlockerPass {
    int vehicle = -1;                        // id of the vehicle that may pass
    int blocker = -1;                        // id of the blocker
    std::int64_t last_needed_tick = 0;       // latest tick at which the blocker was in the way of the vehicle
    std::int64_t blocker_stopped_ticks = 0;  // duration of the blocker's stop when the permission was given
    bool begun = false;                      // true: both vehicles have been in one conflict area at the same time
};

// A decision that ends a deadlock: in a cycle of stopped vehicles that wait for each other, one vehicle proceeds, and
// the vehicle that it waits for yields to it.
struct DeadlockResolution {
    int proceeds = -1;                  // id of the vehicle that proceeds
    int yields = -1;                    // id of its blocker, which yields
    std::int64_t last_needed_tick = 0;  // latest tick at which the decision was applied
};

struct Partition;

// The progress in prefetching the data of the next two partitions.
struct PrefetchProgress {
    const Partition* next = nullptr;    // the next partition; nullptr: no prefetching
    const Partition* second = nullptr;  // the partition after `next`; nullptr: none
    std::size_t lane = 0;               // number of prefetched lanes of `next`: first occupied lanes, then exit lanes
    std::size_t line = 0;               // number of prefetched cache lines of `second`
};

// The V2V message by which a stopped vehicle learns that the queue ahead of it starts. The acceleration in the message
// replaces the acceleration of the receiver. This happens only after all decisions of the step, because the decisions
// for other lanes read the old value.
struct StartMessage {
    int slot;                 // slot of the receiver
    float acceleration_mps2;  // acceleration of the vehicle that has just started ahead of the stopped vehicles
};

// Full dynamics: the acceleration with which the vehicle in `slot` must brake for a hidden leader. A hidden leader is a
// vehicle further ahead on the route of this vehicle. The present leader hides it, but will take another route
// (sim/perception/hidden_leaders.h).
struct BrakingDemand {
    int slot;
    double acceleration_mps2;
};

struct Partition {
    std::vector<int> lanes;        // all lanes of the partition, grouped by intersection
    std::vector<int> connections;  // connections that cross or merge with other connections
    // The bits of `connections` are in the words [first_word, end_word) of the bitsets in JunctionState.
    std::size_t first_word = 0;
    std::size_t end_word = 0;
    std::vector<int> exits;      // exit lanes of `connections`; each exit lane is in the list of one partition only
    std::vector<int> detectors;  // indices of the detectors on `lanes`
    // Lanes that may be occupied: a vehicle has entered the lane, and no step has found the lane empty since then.
    Bitset occupied_candidates;  // [index in `lanes`]
    // Exit lanes that may have a vehicle whose rear is still inside the intersection.
    Bitset exit_candidates;  // [index in `exits`]
    // Cache lines that each step reads, in ascending order of addresses (sim/performance/prefetch.h).
    std::vector<const char*> cache_lines;
    PrefetchProgress prefetch;

    // These members are valid for one step.
    IndexBuffer occupied;                     // lanes with vehicles
    IndexBuffer awake;                        // occupied lanes that do not sleep (QueueState)
    IndexBuffer awake_approaches;             // awake lanes with a stop line
    IndexBuffer awake_connections;            // awake lanes that are connections
    SparseLists<JunctionOccupant> occupants;  // [connection] vehicles inside intersections, furthest downstream first
    // [connection] slots of the vehicles on the approach lane for which right of way on this connection must be decided
    SparseLists<int> approaching;
    std::vector<BrakingDemand> extra_demands;  // full dynamics: braking for hidden leaders, in the order of slots
    std::vector<int> lanes_with_yield_stops;
    std::vector<YieldStops> yield_stops;     // [index in lanes_with_yield_stops]
    SparseLists<SpeedTarget> speed_targets;  // [lane] targets of the present step
    // Stopped vehicles, in the order of lanes and slots. These lists are valid from one delay watch to the next.
    std::vector<StoppedQueue> stopped_queues;
    std::vector<int> stopped_ids;        // ids of the vehicles in stopped_queues
    IndexBuffer lanes_near_end;          // mesoscale mode: lanes whose first vehicle may leave the lane in this step
    std::vector<int> lanes_to_transfer;  // lanes whose first vehicle has left the lane in this step
    std::vector<StartMessage> start_messages;  // mesoscale mode: start messages of this step
    // These members are kept from step to step.
    std::vector<BlockerPass> blocker_passes;
    std::vector<DeadlockResolution> deadlock_resolutions;

    // These members are reports. They are merged into the records of the run after each step.
    std::int64_t present = 0;                    // number of vehicles on the lanes at the start of the step
    std::int64_t updates = 0;                    // number of vehicles moved in the step, including vehicles at rest
    std::int64_t longest_in_junction_ticks = 0;  // longest time that a vehicle has been inside a junction, ticks
    std::int64_t passed_blockers = 0;
    std::int64_t refused = 0;        // vehicles that cooperative clearing begins to hold
    std::int64_t refusal_ticks = 0;  // number of refused vehicles that are stopped at their line
    std::int64_t stops = 0;          // vehicles that stop; counted in steps that attribute delays
    std::int64_t advised = 0;        // vehicles that follow speed advice
    GapCounts gap_counts;
    Violations violations;
    std::vector<Crossing> crossings;
    std::vector<GapAccepted> gaps_accepted;
    std::vector<RuleUse> rule_uses;
    std::vector<V2vModeChange> v2v_mode_changes;
    std::array<std::int64_t, kV2vModes> v2v_mode_steps{};

    // Full dynamics: lanes are added to a lane group until the group has at least this many vehicles. The receive phase
    // of V2V has costs for each group that large groups share.
    static constexpr int group_vehicles(bool has_v2v_channel) { return has_v2v_channel ? 256 : 128; }
    std::array<LaneGroup, 2> groups;  // the group that the kernels compute, and the next one
    FullGroupArrays full_group;
    ReceiveWork receive_work;
    // Mesoscale mode. In moving_blocks a block is not the block of a lane, but a batch of consecutive slots that the
    // kernels move together (MesoKernels::size).
    IndexBuffer moving_blocks;      // blocks to move in this step
    std::vector<int> capped_slots;  // slots of vehicles whose speed cap applies in this step only
    // Extra standstill gaps of the vehicles with a switching policy (ExtraGap in mesoscale/meso_kernels.h): one value
    // for each slot of moving_blocks, in the same order. Empty: 0 for all vehicles.
    std::vector<double> extra_gap_m;
};

}  // namespace stopline
