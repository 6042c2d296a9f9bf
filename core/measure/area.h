// Figures of an area over time, from the fronts that come into it and leave it: throughput, travel time, density (Edie 1963, as
// measure/zones.h), and the same by the side of entry and exit. A front that comes in while its vehicle is inside changes nothing.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "measure/zones.h"
#include "network/lane_graph.h"

namespace stopline {

enum class Side : int { west = 0, south = 1, east = 2, north = 3 };
inline constexpr std::array<const char*, 4> kSideNames{"west", "south", "east", "north"};

// Where a straight lane's traffic comes from, and where it goes to.
Side comes_from(const Lane& lane);
Side goes_to(const Lane& lane);

struct AreaFigures {
    TimeWindow window;
    int left = 0;                // vehicles that left within the window
    double travel_time_s = 0.0;  // their mean; NaN: none
    double vehicles = 0.0;       // mean number in the area
    double occupied = 0.0;       // share of the lanes' metres, 0 .. 1

    double throughput_veh_h() const { return left * 3600.0 / window.length_s(); }
};

struct WayFigures {
    Side from = Side::west;
    Side to = Side::west;
    int left = 0;
    double travel_time_s = 0.0;
};

// Consecutive windows of `interval_s` from 0 to `end_s`, the last one whole. `lane_m`: length of all lanes in the area. Crossings in
// the order of time.
std::vector<AreaFigures> area_series(std::span<const Detector> detectors, std::span<const Crossing> crossings,
                                     double interval_s, double end_s, double lane_m);

// [window][Side] vehicles that came into the area.
std::vector<std::array<int, 4>> inflow_series(const Model& model, std::span<const Crossing> crossings,
                                              double interval_s, double end_s);

// Sixteen, by side of entry and exit.
std::vector<WayFigures> way_figures(const Model& model, std::span<const Crossing> crossings, const TimeWindow& window);

}  // namespace stopline
