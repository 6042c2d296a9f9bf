// Travel time and density of a zone, from the times at which vehicle fronts pass the borders of the zone. A vehicle
// counts in proportion to the time that it spends in the zone (Edie 1963). Density is expressed in two ways: as the
// mean number of vehicles in the zone, and as the share of the lane length that these vehicles cover.
#pragma once

#include <span>
#include <vector>

#include "network/detector.h"
#include "sim/state/events.h"

namespace stopline {

struct TimeWindow {
    double from_s = 0.0;
    double to_s = 0.0;
    double length_s() const { return to_s - from_s; }
    bool contains(double time_s) const { return time_s >= from_s && time_s < to_s; }
};

struct ZoneResult {
    double travel_time_s = 0.0;  // mean of the vehicles that left the zone within the window; NaN if no vehicle left
    double vehicles = 0.0;       // mean number of fronts in the zone
    double occupied = 0.0;       // share of the lane length that vehicles cover, 0 .. 1
    int exited = 0;              // vehicles that left the zone within the window
};

// Measures one zone over a window. `lane_m` is the length of all lanes in the zone. Crossings must be in order of time.
ZoneResult measure_zone(std::span<const Detector> detectors, std::span<const Crossing> crossings, int zone,
                        const TimeWindow& window, double lane_m);

}  // namespace stopline
