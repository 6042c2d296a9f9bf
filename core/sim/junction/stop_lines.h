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

}  // namespace stopline
