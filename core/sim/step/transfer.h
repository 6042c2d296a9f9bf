// Transfers vehicles that have reached the end of their lane.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Moves these vehicles to the next lane of their route, or out of the network.
void transfer_vehicles(const Model& model, State& state);

}  // namespace stopline
