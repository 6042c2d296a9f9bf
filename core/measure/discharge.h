// Queue discharge at stop lines: headways by position in the queue, saturation flow and start-up lost time. By the
// Highway Capacity Manual (6th edition, chapter 31) the saturation headway is the mean headway from the fifth vehicle
// on. The start-up lost time is the sum of (headway - saturation headway) over the first four vehicles. The headway of
// the first vehicle counts from the start of green.
//
// Only vehicles that were queued (slower than kQueuedSpeed_mps) before the stop line count. The queue of a green ends
// before the first other vehicle, because later vehicles arrive at the rate of the demand. A green is saturated if its
// queue has five vehicles or more. Each lane is measured separately. In a mean over all lanes, the values at later
// positions would come only from the lanes with long queues, which can be faster than the other lanes.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "measure/zones.h"
#include "network/lane_graph.h"

namespace stopline {

// The queue discharge of one lane.
struct LaneDischarge {
    std::string lane;                   // name of the lane
    std::vector<double> headway_s;      // [position in the queue, from 0] mean over greens, s
    std::vector<int> samples;           // [position in the queue, from 0] number of headways
    int saturated_greens = 0;           // number of greens with a queue of five vehicles or more
    double saturation_headway_s = 0.0;  // NaN without a saturated green
    double startup_lost_time_s = 0.0;   // mean over the saturated greens; NaN without a saturated green
};

struct Discharge {
    std::vector<LaneDischarge> lanes;    // lanes with a stop line, in the order of the detectors
    int saturated_greens = 0;            // sum over the lanes
    double saturation_headway_s = 0.0;   // mean over all headways of all lanes; NaN without a saturated green
    double saturation_flow_veh_h = 0.0;  // per lane; NaN without a saturated green
    double startup_lost_time_s = 0.0;    // mean over saturated greens of all lanes; NaN without a saturated green
    double vehicles_per_green = 0.0;  // mean per lane and green; vehicles on yellow and vehicles without stop included
    int greens = 0;                   // number of greens per lane within the window
};

// Returns the start, in s, of the latest green of a signal group at `time_s`; below 0 if no green has begun.
using LatestGreenStart = std::function<double(int signal_group, double time_s)>;
// Returns true if the vehicle was queued before the stop line that it passes.
using HasQueued = std::function<bool(int vehicle)>;

// Measures all stop lines. A vehicle belongs to the latest green that began before it passed its stop line. Headways of
// a green that began before the window are left out. Crossings must be in order of time.
Discharge discharge(const LaneGraph& graph, std::span<const Detector> detectors, std::span<const Crossing> crossings,
                    const TimeWindow& window, const LatestGreenStart& latest_green_start_s, double cycle_s,
                    const HasQueued& has_queued);

}  // namespace stopline
