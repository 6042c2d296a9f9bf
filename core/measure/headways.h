// Passages of stop lines, with queue positions and headways.
#pragma once

#include <span>
#include <vector>

#include "network/lane_graph.h"
#include "sim/state/events.h"

namespace stopline {

// The passage of a front over a stop line.
struct LinePassage {
    double time_s = 0.0;  // since the start of green
    int lane = 0;         // lane with the stop line
    int position = 1;     // position in the queue of the lane, from 1
    int vehicle = 0;
    int policy = 0;
    double speed_mps = 0.0;
    double headway_s = 0.0;  // since the previous passage on the same lane; NaN for the first one
};

// Returns the passages of stop lines from the start of green on, ordered by lane and then by time.
std::vector<LinePassage> line_passages(const LaneGraph& graph, const std::vector<Passage>& passages,
                                       double green_start_s);

// Returns the passages up to the time `green_s` after the start of green.
std::vector<LinePassage> within_green(const std::vector<LinePassage>& passages, double green_s);

// The flow at the end of the queue: means over the last `positions` passages of each lane. The first passage of a lane
// does not count, because it has no headway. `passages` must be ordered by lane and then by time.
struct LastPositionsFlow {
    int vehicles = 0;        // number of passages in the means
    double headway_s = 0.0;  // NaN if there are no passages
    double speed_mps = 0.0;
};
LastPositionsFlow last_positions_flow(const std::vector<LinePassage>& passages, int positions);

// Returns the mean of the values, or NaN if there are none.
double mean(std::span<const double> values);

}  // namespace stopline
