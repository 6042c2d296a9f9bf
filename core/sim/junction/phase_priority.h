// Right of way that changes with the phases of a signal.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Sets the right of way of the present phase of each signal. Call it once in each step, before the decisions.
void update_phase_priorities(const Model& model, State& state);

}  // namespace stopline
