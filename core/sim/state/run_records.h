// Events and counters since the start of a run. Every phase may append. The simulation reads only the vehicle count.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "network/lane_graph.h"
#include "sim/state/events.h"

namespace stopline {

// Events are in the order of their steps.
struct RunRecords {
    std::vector<Passage> passages;
    std::vector<Crossing> crossings;
    std::vector<GapAccepted> gaps_accepted;
    std::vector<LaneChange> lane_changes;
    std::vector<std::array<std::int64_t, kMaxTurns>> turned;  // [approach][Turn] vehicles
    Violations violations;
    std::int64_t entered = 0;
    std::int64_t exited = 0;
    std::int64_t updates = 0;              // vehicles times steps, including vehicles at rest
    std::int64_t longest_in_junction = 0;  // longest stay of any JunctionOccupant, ticks
};

}  // namespace stopline
