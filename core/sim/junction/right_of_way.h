// Decides right of way inside intersections.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Decides which vehicles of a partition must yield, and adds their yield stops. Finally counts the conflicts of this
// step.
void decide_right_of_way(const Model& model, State& state, Partition& part);

}  // namespace stopline
