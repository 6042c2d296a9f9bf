// Inserts vehicles with a trip of their own (DemandPlan::trips).
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Inserts the vehicles whose trip is due and that have room.
void insert_trips(const Model& model, State& state);

}  // namespace stopline
