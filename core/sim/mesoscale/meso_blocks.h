// Selects the vehicles that a step of the mesoscale mode must move.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Lists the blocks of slots whose vehicles can move, and caps the speed of vehicles that must stop. The list does not
// contain standing queues.
void collect_moving_blocks(const Model& model, State& state, Partition& part);

}  // namespace stopline
