// Right of way that changes with the phases of a signal.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Sets the right of way of the present phase of each signal. Call this function once in each step, before right of way
// is decided.
void update_phase_priorities(const Model& model, State& state);

}  // namespace stopline
