// Queue discharge at stop lines: headways by position in the queue, saturation flow and start-up lost time. By the
// Highway Capacity Manual (6th edition, chapter 31) the saturation headway is the mean from the fifth vehicle on. The
// start-up lost time is the sum over the first four vehicles of the headway minus the saturation headway. The headway
// of the first vehicle counts from the start of green.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "measure/zones.h"
#include "network/lane_graph.h"

namespace stopline {

struct Discharge {
    std::vector<double> headway_s;       // [position in the queue, from 0] mean over lanes and greens, s
    std::vector<int> samples;            // [position in the queue, from 0] number of headways
    double saturation_headway_s = 0.0;   // NaN if no green had a fifth vehicle
    double saturation_flow_veh_h = 0.0;  // per lane; NaN if no green had a fifth vehicle
    double startup_lost_time_s = 0.0;    // NaN if no green had a fifth vehicle
    double vehicles_per_green = 0.0;     // mean per lane and green; vehicles on yellow included
    int greens = 0;                      // number of greens per lane within the window
};

// Returns the start, in s, of the latest green of a signal group at `time_s`; below 0 if no green has begun.
using LatestGreenStart = std::function<double(int signal_group, double time_s)>;

// Measures all stop lines together. A vehicle belongs to the latest green that began before it passed its stop line.
// Headways of a green that began before the window are left out. Crossings must be in order of time.
Discharge discharge(const LaneGraph& graph, std::span<const Detector> detectors, std::span<const Crossing> crossings,
                    const TimeWindow& window, const LatestGreenStart& latest_green_start_s, double cycle_s);

}  // namespace stopline
