// Signals and stop lines.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Reads the signals of this step.
void update_signals(const Model& model, std::int64_t tick, StopLines& stop_lines);

// Decides which vehicle stops at each stop line of a partition, for its signal or for the keep-clear rule. Lists the
// approaching vehicles for which right of way must be decided.
void decide_stop_lines(const Model& model, State& state, Partition& part);

}  // namespace stopline
