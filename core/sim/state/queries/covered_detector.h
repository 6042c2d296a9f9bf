#pragma once

#include <cstddef>

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Returns true if a vehicle covers a part of the detector: its front is at or beyond the start of the detector, on the
// same lane or on one of the next two lanes of its route, and its rear is before the end of the detector. The detector
// must lie on a lane.
bool is_covered(const Model& model, const State& state, std::size_t detector);

}  // namespace stopline
