// Lane changes on the approaches of intersections: decides which vehicle wants to change lanes, and whether the change
// is safe. A lane change takes no time.
//
// Mandatory changes serve the route. They follow the strategic changes of SUMO's LC2013 (Erdmann 2015, "SUMO's
// lane-changing model"). A vehicle on a lane that does not serve its route changes as soon as the gaps allow it. Near
// the stop line it aligns its speed with a gap. If it finds no gap, it stops before the line and waits for one.
//
// Discretionary changes serve the speed. They follow MOBIL (Kesting, Treiber, Helbing 2007, "General lane-changing
// model MOBIL for car-following models"). A vehicle changes if the other lane allows a higher acceleration. The
// intelligent driver model with the gap of the policy gives the accelerations.
#pragma once

#include "sim/perception/lane_gaps.h"

namespace stopline {

// A vehicle that may change lanes, and the lane changes that it wants.
struct LaneChangeRequest {
    int lane = -1;
    int slot = -1;
    double front_m = 0.0;
    double length_m = 0.0;
    double speed_mps = 0.0;
    int policy = 0;
    Turn turn = Turn::none;
    int lane_changes = 0;    // lane changes required before the stop line; below 0: to the left; 0: none
    double to_line_m = 0.0;  // distance to the position where the vehicle would stop before the line
    // The two members below are set if no lane change is required before the stop line and the vehicle's turn at the
    // second intersection ahead is known. preferred_offset is the number of lanes to the best lane, from which the
    // vehicle needs the fewest lane changes after the first intersection; below 0: to the left.
    int preferred_offset = 0;
    double to_next_line_m = 0.0;  // distance to the stop line of the second intersection ahead
};
// Returns the request of the vehicle in `slot` of `lane`.
LaneChangeRequest lane_change_request(const Model& model, const State& state, int lane, int slot);

// Returns the argument `share` of required_gap_m() for a mandatory change. Near the stop line a change is more urgent,
// so vehicles accept a smaller part of their policy's gap there.
double urgent_share(const Model& model, double to_line_m);

// Returns the position where a vehicle waits before the stop line to change lanes, m from the start of the lane.
// Left-bound vehicles wait nearer to the stop line than right-bound ones. Two vehicles that want to swap lanes thus do
// not block each other.
double waiting_position_m(const Model& model, const State& state, const LaneChangeRequest& me);

// Carries out lane changes. Each vehicle considers a lane change only in some steps, so the function treats only the
// vehicles that consider one in this step.
void change_lanes(const Model& model, State& state);

}  // namespace stopline
