// Runs the signal controllers (signals/signal_controller.h). Between two steps, SignalState holds the lights of the
// step that comes next.
#pragma once

#include "base/state_hash.h"
#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Sets the lights and the memory of all controllers for the first step.
void start_signals(const Model& model, State& state);

// Sets the lights of the tick State::tick. Calls only those controllers that asked for a call at this tick. A
// controller that follows a programme asks for the ticks at which a light changes.
void update_signals(const Model& model, State& state);

// Adds to the hash the lights and the memory of each controller that does not follow a programme.
void add_signals(const Model& model, const State& state, StateHash& hash);

}  // namespace stopline
