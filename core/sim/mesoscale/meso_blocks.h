// Selects the vehicles that a step of the mesoscale mode must move. Works on one partition, a group of whole
// intersections.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Lists the blocks that the kernels must update. A block consists of MesoKernels::size consecutive slots. Leaves out a
// block if all of its vehicles will remain stopped in this step. Caps the speed of vehicles that must stop or align
// with a gap.
void collect_moving_blocks(const Model& model, State& state, Partition& part);

}  // namespace stopline
