// Travel time and density of a zone, from the fronts that pass its bounds. Edie's definitions (1963): density is the mean
// number of vehicles in the zone, here times their length and over the length of its lanes, so a share of road metres.
#pragma once

#include <span>
#include <vector>

#include "sim/events.h"
#include "sim/model.h"

namespace stopline {

struct TimeWindow {
    double from_s = 0.0;
    double to_s = 0.0;
    double length_s() const { return to_s - from_s; }
    bool contains(double time_s) const { return time_s >= from_s && time_s < to_s; }
};

struct ZoneFigures {
    double travel_time_s = 0.0;  // mean of the vehicles that leave the zone within the window; NaN: none
    double vehicles = 0.0;       // mean number of fronts in the zone
    double occupied = 0.0;       // share of the lanes' metres, 0 .. 1
    int left = 0;                // vehicles that left within the window
};

// `lane_m`: length of all lanes in the zone. Crossings in the order of time, as a run gives them.
ZoneFigures zone_figures(std::span<const Detector> detectors, std::span<const Crossing> crossings, int zone,
                         const TimeWindow& window, double lane_m);

}  // namespace stopline
