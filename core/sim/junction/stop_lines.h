// Decisions at stop lines. decide_stop_lines() works on one partition, a group of whole intersections.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Decides for each stop line of a partition which vehicle stops there, for its signal or for the keep-clear rule. Lists
// the approaching vehicles for which right of way must be decided.
void decide_stop_lines(const Model& model, State& state, Partition& part);

// Returns the highest deceleration with which a driver stops for a signal. On yellow this is the setting
// `stop.decision_deceleration`, on any other light the maximum braking.
double stopping_deceleration_mps2(const DriverTables& driver, Light light);

// Returns true if the vehicle in `slot` can stop for a signal that shows `light`, which is not green. `line_m`: stop
// line, m from the start of the lane of the vehicle. Vehicles of the mesoscale mode brake without lag. In imported
// networks this counts at a red signal: after a short lane, a vehicle reaches the line with a speed from which it can
// just stop.
bool can_stop_for_signal(const Model& model, const VehicleArrays& v, int slot, double line_m, Light light);

}  // namespace stopline
