// Changing lanes, on the approaches of intersections: who wants to, and when it is safe.
//
// For the route (the strategic changes of SUMO's LC2013, Erdmann 2015, "SUMO's lane-changing model"): a vehicle on a lane from which its
// route does not go on changes as soon as the gaps beside it allow it; near the stop line it adapts its speed to them, and at last it
// waits before the line for one. For speed (MOBIL; Kesting, Treiber, Helbing 2007, "General lane-changing model MOBIL for car-following
// models"): where that brings more acceleration, by the intelligent driver model with the gap of the policy. A change takes no time.
#pragma once

#include "sim/lane_gaps.h"

namespace stopline {

// One vehicle on a lane with others beside, and where it wants to go.
struct Changer {
    int lane = -1;
    int slot = -1;
    double front_m = 0.0;
    double length_m = 0.0;
    double speed_mps = 0.0;
    int policy = 0;
    Turn turn = Turn::none;
    int changes = 0;         // that its route takes (WayOn::changes)
    double to_line_m = 0.0;  // front to stop line
};
Changer changer_at(const Model& model, const State& state, int lane, int slot);

// Of the gaps that a vehicle needs for its route, this near to the stop line.
double urgent_share(const Model& model, double to_line_m);

// Where a vehicle waits before the stop line to change: those that go to the left further on than those that go to the right, so that
// two that want each other's lane do not stand side by side. From the lane's start.
double waiting_place_m(const Model& model, const State& state, const Changer& me);

// How far a vehicle needs to stop comfortably.
double comfortable_stop_m(const Model& model, double speed_mps);

}  // namespace stopline
