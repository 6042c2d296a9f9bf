// Passages of stop lines: queue positions and the headways between them.
#pragma once

#include <span>
#include <vector>

#include "network/lane_graph.h"
#include "sim/events.h"

namespace stopline {

// A front at a stop line.
struct LinePassage {
    double time_s = 0.0;  // since the start of green
    int lane = 0;         // whose end the line is
    int position = 1;     // in the queue of its lane
    int vehicle = 0;
    int policy = 0;
    double speed_mps = 0.0;
    double headway_s = 0.0;  // since the front before it on the same lane; NaN for the first
};

// All passages of stop lines, lane by lane, in the order of passing. Passages before the start of green are left out.
std::vector<LinePassage> line_passages(const LaneGraph& graph, const std::vector<Passage>& passages,
                                       double green_start_s);

// The passages within the green time.
std::vector<LinePassage> within_green(const std::vector<LinePassage>& passages, double green_s);

// What the end of the queue does at the line: mean over the last `positions` passages of each lane.
struct LateFlow {
    int vehicles = 0;        // that the means are over
    double headway_s = 0.0;  // NaN without vehicles
    double speed_mps = 0.0;
};
LateFlow late_flow(const std::vector<LinePassage>& passages, int positions);

// Mean of the values; NaN of none.
double mean(std::span<const double> values);

}  // namespace stopline
