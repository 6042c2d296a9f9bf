// Lane changes on the approaches of intersections: which vehicle wants to change, and when it is safe. A change takes
// no time.
//
// Mandatory changes serve the route. They follow the strategic changes of SUMO's LC2013 (Erdmann 2015, "SUMO's
// lane-changing model"). A vehicle on a lane that does not serve its route changes as soon as the gaps allow it. Near
// the stop line it aligns its speed with a gap, and finally waits for one before the line.
//
// Discretionary changes serve the speed. They follow MOBIL (Kesting, Treiber, Helbing 2007, "General lane-changing
// model MOBIL for car-following models"). A vehicle changes if the other lane allows a higher acceleration, computed
// with the intelligent driver model and the gap of the policy.
#pragma once

#include "sim/perception/lane_gaps.h"

namespace stopline {

// A vehicle on a lane with adjacent lanes, and the lane changes that it wants.
struct LaneChangeRequest {
    int lane = -1;
    int slot = -1;
    double front_m = 0.0;
    double length_m = 0.0;
    double speed_mps = 0.0;
    int policy = 0;
    Turn turn = Turn::none;
    int lane_changes = 0;    // changes that the route requires, signed as TurnOption::lane_changes
    double to_line_m = 0.0;  // distance to the stopping position before the line
    // Set if the route requires no change here and the following turn is known: offset to the nearest lane from which
    // the fewest changes remain behind the intersection, and the distance to the next stop line there.
    int preferred_offset = 0;
    double to_next_line_m = 0.0;
};
// Returns the request of the vehicle in `slot` of `lane`.
LaneChangeRequest lane_change_request(const Model& model, const State& state, int lane, int slot);

// Returns the share of the policy's gap that a mandatory change requires. It falls towards the stop line.
double urgent_share(const Model& model, double to_line_m);

// Returns where a vehicle waits before the stop line to change lanes, m from the lane's start. Left-bound vehicles wait
// nearer to the stop line than right-bound ones, so two vehicles that want to swap lanes do not block each other.
double waiting_position_m(const Model& model, const State& state, const LaneChangeRequest& me);

// Changes the lanes of all vehicles for which a change is due and safe.
void change_lanes(const Model& model, State& state);

}  // namespace stopline
