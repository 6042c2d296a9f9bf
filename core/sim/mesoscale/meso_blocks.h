// Selects the vehicles that a step of the mesoscale mode must move.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Lists the blocks of slots with vehicles that can move, and sets the speed caps of vehicles that must stop. Standing
// queues are left out.
void collect_moving_blocks(const Model& model, State& state, Partition& part);

}  // namespace stopline
