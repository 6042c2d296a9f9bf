// Decides right of way inside intersections. Works on one partition, a group of whole intersections.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Decides which vehicles of a partition must yield, and stores for each of them where it must stop (YieldStop). Finally
// counts the conflicts of this step: pairs of vehicles in the same conflict area.
void decide_right_of_way(const Model& model, State& state, Partition& part);

}  // namespace stopline
