// The events and counters since the start of a run. Every phase may append to them. The simulation itself reads only
// `entered` and `exited`, to get the number of vehicles present.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "network/lane_graph.h"
#include "sim/state/events.h"
#include "sim/state/gap_requests.h"

namespace stopline {

// Each list of events is in the order of the steps in which the events occurred.
struct RunRecords {
    std::vector<Passage> passages;
    std::vector<Crossing> crossings;
    std::vector<GapAccepted> gaps_accepted;
    std::vector<LaneChange> lane_changes;
    std::vector<V2vModeChange> v2v_mode_changes;
    // [mode] time that vehicles with an active V2V channel drive in the mode behind a leader, in vehicle steps
    std::array<std::int64_t, kV2vModes> v2v_mode_steps{};
    std::vector<std::array<std::int64_t, kMaxTurns>>
        turned;  // [approach][Turn] number of vehicles that have made the turn
    Violations violations;
    GapCounts gap_counts;
    std::int64_t entered = 0;
    std::int64_t exited = 0;
    std::int64_t updates = 0;                    // vehicles present, summed over all steps; includes vehicles at rest
    std::int64_t longest_in_junction_ticks = 0;  // longest time of any vehicle inside a junction, ticks
};

}  // namespace stopline
