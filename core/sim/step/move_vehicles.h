// Moves all vehicles of a partition, a group of whole intersections.
#pragma once

#include "sim/full_dynamics/full_dynamics.h"
#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Moves the vehicles. Then lists the lanes on which the first vehicle has passed the end of the lane
// (Partition::lanes_to_transfer).
void move_vehicles(const Model& model, const FullTables& tables, State& state, Partition& part);

}  // namespace stopline
