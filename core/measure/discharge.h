// What a signal engineer asks of a stop line: headways by position in the queue, saturation flow, start-up lost time (Highway
// Capacity Manual, 6th edition, chapter 31: the saturation headway is the mean from the fifth vehicle on, the lost
// time is what the first four take beyond it).
#pragma once

#include <span>
#include <vector>

#include "measure/zones.h"

namespace stopline {

struct Discharge {
    std::vector<double> headway_s;      // [position in the queue, from 0]: mean over lanes and greens
    std::vector<int> samples;           // [position]
    double saturation_headway_s = 0.0;  // NaN where no fifth vehicle passed
    double saturation_flow_veh_h = 0.0;
    double lost_time_s = 0.0;         // NaN likewise
    double vehicles_per_green = 0.0;  // per lane and green, those on yellow included
    int greens = 0;                   // per lane, whole within the window
};

// Over all stop lines. A vehicle belongs to the last green that began before it passed.
Discharge discharge(const Model& model, std::span<const Crossing> crossings, const TimeWindow& window);

}  // namespace stopline
