// The unit of parallel work in a step: the lanes of some whole intersections, with their scratch memory and reports.
// The lanes of all partitions in order are the same sequence for any number of partitions, and so are the reports.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/containers/bitset.h"
#include "base/containers/index_buffer.h"
#include "sim/state/delay_log.h"
#include "sim/state/events.h"
#include "sim/state/vehicles/full_group.h"
#include "sim/state/vehicles/lane_group.h"

namespace stopline {

// A vehicle that may pass a blocker, which has been stopped inside the intersection for long.
struct BlockerPass {
    int vehicle = -1;  // vehicle id
    int blocker = -1;  // vehicle id
    std::int64_t last_needed_tick = 0;
    std::int64_t blocker_stopped_ticks = 0;  // when the pass was granted
    bool begun = false;                      // both have been in the same conflict area
};

// Two vehicles without priority waited for each other while stopped. One proceeds, the other yields.
struct DeadlockResolution {
    int proceeds = -1;  // vehicle id
    int yields = -1;    // vehicle id
    std::int64_t last_needed_tick = 0;
};

struct Partition;

// How far the memory of the next two partitions has been prefetched.
struct PrefetchProgress {
    const Partition* next = nullptr;
    const Partition* second = nullptr;  // the partition after the next
    std::size_t lane = 0;               // index of the next lane to prefetch, in Partition::occupied of `next`
    std::size_t line = 0;               // index of the next line to prefetch, in Partition::cache_lines of `second`
};

// A V2V message that the queue ahead starts. It is applied when vehicles move, since other lanes still read the state.
struct StartMessage {
    int slot;
    float acceleration_mps2;
};

// The acceleration demanded by a hidden leader, full dynamics.
struct BrakingDemand {
    int slot;
    double acceleration_mps2;
};

struct Partition {
    std::vector<int> lanes;        // by intersection
    std::vector<int> connections;  // lanes inside an intersection that cross or merge with others
    std::size_t first_word = 0;    // words [first_word, end_word) of the bitsets hold these connections
    std::size_t end_word = 0;
    std::vector<int> exits;      // exit lanes of the connections
    std::vector<int> detectors;  // on the lanes
    // Lanes that got a vehicle since they were last found empty, and exits that may have a vehicle reaching back.
    Bitset occupied_candidates;  // [index in lanes]
    Bitset exit_candidates;      // [index in exits]
    // Cache lines that each step reads, in the order of memory (sim/performance/prefetch.h).
    std::vector<const char*> cache_lines;
    PrefetchProgress prefetch;

    // Valid for one step.
    IndexBuffer occupied;                      // lanes with vehicles
    IndexBuffer awake;                         // occupied lanes that do not sleep (QueueState)
    IndexBuffer awake_approaches;              // awake lanes with a stop line
    IndexBuffer awake_connections;             // awake lanes inside an intersection
    std::vector<int> occupied_connections;     // connections with occupants
    std::vector<BrakingDemand> extra_demands;  // full dynamics: by lane as in `awake`, then by slot
    std::vector<int> lanes_with_yield_stops;
    std::vector<int> lanes_with_alignments;
    IndexBuffer stopped_slots;                 // valid if delays are attributed in this step
    int earliest_stop_tick = 0;                // tick since which one of these has been stopped
    IndexBuffer lanes_near_end;                // mesoscale mode: lanes whose first vehicle may reach the end
    std::vector<int> lanes_to_transfer;        // lanes whose first vehicle has reached the end
    std::vector<StartMessage> start_messages;  // mesoscale mode
    // Kept from step to step.
    std::vector<BlockerPass> blocker_passes;
    std::vector<DeadlockResolution> deadlock_resolutions;

    // Reports, merged into the records after each step.
    std::int64_t present = 0;  // vehicles
    std::int64_t updates = 0;
    std::int64_t longest_in_junction = 0;  // ticks
    std::int64_t passed_blockers = 0;
    Violations violations;
    std::vector<Crossing> crossings;
    std::vector<GapAccepted> gaps_accepted;
    std::vector<RuleUse> rule_uses;

    // Full dynamics: lanes go through the kernels in groups of at least this many vehicles.
    static constexpr int kGroupVehicles = 128;
    std::array<LaneGroup, 2> groups;  // present and next group
    FullGroupArrays full_group;
    // Mesoscale mode: blocks of slots to move, slots with a speed cap, and their ExtraGap values.
    IndexBuffer moving_blocks;
    std::vector<int> capped_slots;
    std::vector<double> extra_gap_m;
};

}  // namespace stopline
