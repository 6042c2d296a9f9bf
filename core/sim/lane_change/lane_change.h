// Lane changes on the approaches of intersections: decides which vehicle wants to change lanes, and whether the change
// is safe. A lane change takes no time.
//
// Mandatory changes serve the route. They follow the strategic changes of SUMO's LC2013 (Erdmann 2015, "SUMO's
// lane-changing model"), except that queues beyond the next intersection do not count. A vehicle on a lane that does
// not serve its route begins to look for a gap at some distance from the stop line, and changes as soon as the gaps
// allow it. Until then it aligns its speed with a gap. If it finds no gap, it stops before the line and waits for one.
//
// Discretionary changes serve the speed. They follow MOBIL (Kesting, Treiber, Helbing 2007, "General lane-changing
// model MOBIL for car-following models"). A vehicle changes if the other lane has allowed a higher acceleration for
// some time. The intelligent driver model gives the accelerations on both lanes. The desired gap in this model is that
// of the vehicle's spacing policy.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

#include "sim/perception/lane_gaps.h"

namespace stopline {

inline constexpr double kNoPocket_m = std::numeric_limits<double>::infinity();

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
    double to_line_m = 0.0;  // distance to the stopping position before the line
    // A pocket is a lane that begins downstream of the start of the approach. If the turn needs a pocket, this is the
    // smallest position of the vehicle's front, in m, at which the pocket is beside the full length of the vehicle. If
    // not: kNoPocket_m.
    double pocket_entry_m = kNoPocket_m;
    // The last two members are set if no lane change is required and another lane suits the later turns better
    // (preferred_lane.h). An offset below 0 means to the left.
    std::int8_t preferred_offset = 0;
    double to_preferred_line_m = 0.0;  // distance to the stop line of the turn for which the other lane is better
};
// Returns the request of the vehicle in `slot` of `lane`.
LaneChangeRequest lane_change_request(const Model& model, const State& state, int lane, int slot);

// A mandatory change, or a change to the lane that suits the later turns better (LaneChangeRequest::preferred_offset).
struct MandatoryChange {
    int lane_changes = 0;  // number of lane changes; below 0: to the left; 0: none is due
    // Distance that the vehicle has left for the lane changes: the distance to the stop line of the turn that needs
    // them, minus the length of the queue on the target lane before the next intersection. The turn may be at a later
    // intersection; queues beyond the next one do not count. If the changes lead into a pocket, the usable distance is
    // at most the distance to pocket_entry_m.
    double usable_m = 0.0;
    double look_ahead_m = 0.0;  // usable distance below which the vehicle looks for a gap

    // Returns how urgent the change is: 0 where the search for a gap begins, 1 where no usable distance is left.
    double urgency() const { return std::clamp(1.0 - usable_m / look_ahead_m, 0.0, 1.0); }
};
// Returns the change for which a vehicle has to look for a gap now.
MandatoryChange mandatory_change(const Model& model, const State& state, const LaneChangeRequest& me);

// Returns the share of the spacing policy's gap that a vehicle requires for a mandatory change (argument of
// required_gap_m() in lane_gaps.h). The more urgent the change, the smaller the share. `urgency`: 0 to 1, see
// MandatoryChange.
double urgent_share(const LaneChangeSettings& settings, double urgency);

// Returns the position where a vehicle waits before the stop line to change lanes, m from the start of the lane.
// Left-bound vehicles wait nearer to the stop line than right-bound ones. Two vehicles that want to swap lanes thus do
// not block each other. A vehicle that is one lane change away from a pocket waits upstream of the queue in the pocket.
// A vehicle that needs several lane changes to reach a pocket waits beside the start of the pocket, unless it has
// already passed this start.
double waiting_position_m(const Model& model, const State& state, const LaneChangeRequest& me);

// Returns true if a vehicle needs a lane change for its next turn, is slower than kCrawlingSpeed_mps, and is less than
// 2 m upstream of its waiting position or has passed it.
bool has_reached_waiting_position(const Model& model, const State& state, const LaneChangeRequest& me);

// Carries out lane changes. A vehicle decides about a lane change only every half second. A call treats only the
// vehicles that decide in this step.
void change_lanes(const Model& model, State& state);

}  // namespace stopline
