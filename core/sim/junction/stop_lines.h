// Decisions at stop lines. decide_stop_lines() works on one partition, a group of whole intersections.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Decides for each stop line of a partition which vehicle stops there, for its signal or for the keep-clear rule. Lists
// the approaching vehicles for which right of way must be decided.
void decide_stop_lines(const Model& model, State& state, Partition& part);

}  // namespace stopline
