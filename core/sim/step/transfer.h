// Transfers vehicles from one lane to the next.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Moves each vehicle that has reached the end of its lane to the next lane of its route, or out of the network. A
// vehicle whose lane does not allow the next turn of its trip is teleported or stopped instead.
void transfer_vehicles(const Model& model, State& state);

}  // namespace stopline
