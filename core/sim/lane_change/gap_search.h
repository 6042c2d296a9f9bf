// Prepares mandatory lane changes.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Adapts the speed of each vehicle that must change lanes to a gap in the target lane, and makes other vehicles open
// gaps. A vehicle that finds no gap stops before the stop line.
void prepare_lane_changes(const Model& model, State& state, Partition& part);

}  // namespace stopline
