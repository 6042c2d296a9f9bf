// The net gap that a spacing policy keeps at a speed.
#pragma once

#include "sim/state/model.h"

namespace stopline {

// Returns the net gap that a vehicle of the policy keeps behind a leader of the same constant speed, m.
double desired_gap_m(const Model& model, int policy, double speed_mps);

}  // namespace stopline
