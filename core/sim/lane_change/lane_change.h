// Lane changes on the approaches of intersections: decides which vehicle wants to change lanes, and whether the change
// is safe. A lane change takes no time.
//
// Mandatory changes serve the route. They follow the strategic changes of SUMO's LC2013 (Erdmann 2015, "SUMO's
// lane-changing model"). A vehicle on a lane that does not serve its route changes as soon as the gaps allow it. Near
// the stop line it aligns its speed with a gap. If it finds no gap, it stops before the line and waits for one.
//
// Discretionary changes serve the speed. They follow MOBIL (Kesting, Treiber, Helbing 2007, "General lane-changing
// model MOBIL for car-following models"). A vehicle changes if the other lane allows a higher acceleration, computed
// with the intelligent driver model and the gap of the policy.
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
    int lane_changes = 0;    // lane changes before the stop line, signed as TurnOption::lane_changes; 0: none required
    double to_line_m = 0.0;  // distance to the stopping position before the line
    // The last two members are set if no lane change is required and the following turn is known. The offset is signed
    // as TurnOption::lane_changes.
    int preferred_offset = 0;     // offset to the lane that requires the fewest changes past the intersection
    double to_next_line_m = 0.0;  // distance to the stop line of the second intersection ahead
};
// Returns the request of the vehicle in `slot` of `lane`.
LaneChangeRequest lane_change_request(const Model& model, const State& state, int lane, int slot);

// Returns the share of the policy's gap that a mandatory change requires. The share falls towards the stop line.
double urgent_share(const Model& model, double to_line_m);

// Returns the position where a vehicle waits before the stop line to change lanes, m from the start of the lane.
// Left-bound vehicles wait nearer to the stop line than right-bound ones. Two vehicles that want to swap lanes thus do
// not block each other.
double waiting_position_m(const Model& model, const State& state, const LaneChangeRequest& me);

// Carries out the lane changes of all vehicles that decide in this step.
void change_lanes(const Model& model, State& state);

}  // namespace stopline
