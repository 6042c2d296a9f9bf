// Prepares mandatory lane changes.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Aligns the speed of vehicles that must change lanes with gaps in the target lane, and makes other vehicles open gaps
// for them. A vehicle that finds no gap stops before the stop line.
void prepare_lane_changes(const Model& model, State& state, Partition& part);

}  // namespace stopline
