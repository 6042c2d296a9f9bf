// Throughput, travel time and density of an area over time, from the times at which vehicle fronts enter and leave it
// (Edie 1963, see measure/zones.h). Throughput and travel time are also measured by side of entry and side of exit. A
// second entry of a vehicle that has not left is ignored.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "measure/zones.h"
#include "network/lane_graph.h"
#include "network/side.h"

namespace stopline {

struct AreaResult {
    TimeWindow window;
    int exited = 0;              // vehicles that left the area within the window
    double travel_time_s = 0.0;  // mean over these vehicles; NaN if no vehicle left
    double vehicles = 0.0;       // mean number of vehicles in the area
    double occupied = 0.0;       // share of the lane length that vehicles cover, 0 .. 1

    double throughput_veh_h() const { return exited * 3600.0 / window.length_s(); }
};

struct OriginDestinationResult {
    Side from = Side::west;
    Side to = Side::west;
    int exited = 0;              // vehicles that left the area within the window
    double travel_time_s = 0.0;  // mean over these vehicles; NaN if no vehicle left
};

// In the functions below, crossings must be in order of time. Detectors of any kind but `zone` are ignored.

// Measures consecutive windows of `interval_s` from 0 to `end_s`. An incomplete last window is omitted. `lane_m` is the
// length of all lanes in the area.
std::vector<AreaResult> area_series(std::span<const Detector> detectors, std::span<const Crossing> crossings,
                                    double interval_s, double end_s, double lane_m);

// Counts the vehicles that entered the area, by window and side: [window][Side]. The windows are those of
// area_series().
std::vector<std::array<int, 4>> inflow_series(const LaneGraph& graph, std::span<const Detector> detectors,
                                              std::span<const Crossing> crossings, double interval_s, double end_s);

// Returns the results for all 16 pairs of entry side and exit side.
std::vector<OriginDestinationResult> origin_destination_results(const LaneGraph& graph,
                                                                std::span<const Detector> detectors,
                                                                std::span<const Crossing> crossings,
                                                                const TimeWindow& window);

}  // namespace stopline
