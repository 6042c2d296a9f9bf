// Counts conflicts: pairs of vehicles from different connections in the same conflict area. Works on one partition, a
// group of whole intersections.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Adds the conflicts of this step at the intersections of a partition to the violations of the partition.
void count_conflicts(const Model& model, const State& state, Partition& part);

}  // namespace stopline
