// Selects the vehicles that a step of the mesoscale mode must move. Works on one partition, a group of whole
// intersections.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Lists the blocks of slots that the kernels must update (MesoKernels::size). Leaves out a block if all of its vehicles
// are stopped in a queue. Caps the speed of vehicles that must stop or align with a gap.
void collect_moving_blocks(const Model& model, State& state, Partition& part);

}  // namespace stopline
