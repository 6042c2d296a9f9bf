// Counts vehicles from different connections in the same conflict area.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Adds the conflicts of this step to the violations of a partition.
void count_conflicts(const Model& model, const State& state, Partition& part);

}  // namespace stopline
