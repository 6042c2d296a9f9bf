// Decides right of way inside intersections. Works on one partition, a group of whole intersections.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Decides which vehicles of a partition must yield, and adds a YieldStop for each of them. Finally counts the conflicts
// of this step.
void decide_right_of_way(const Model& model, State& state, Partition& part);

}  // namespace stopline
