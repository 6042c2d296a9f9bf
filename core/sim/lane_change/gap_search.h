// Preparation of mandatory lane changes.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Aligns vehicles that must change lanes with gaps in the target lane, opens gaps for them, and stops them before the
// stop line if they find none.
void prepare_lane_changes(const Model& model, State& state, Partition& part);

}  // namespace stopline
