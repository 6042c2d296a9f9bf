// Finds the vehicles inside intersections. Works on one partition, a group of whole intersections.
#pragma once

#include "sim/state/state.h"

namespace stopline {

// Lists the occupants of each connection of a partition. Updates the bitsets of connections in JunctionState:
// `occupied`, `with_stopped` and `to_decide`.
void find_junction_occupants(const State& state, JunctionState& junctions, Partition& part);

}  // namespace stopline
