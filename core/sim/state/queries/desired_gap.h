// The net gap that a gap policy keeps at a speed.
#pragma once

#include "sim/state/model.h"

namespace stopline {

// Returns the net gap in equilibrium, m.
double desired_gap_m(const Model& model, int policy, double speed_mps);

}  // namespace stopline
