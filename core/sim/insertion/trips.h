// Inserts the vehicles of trips (DemandPlan::trips).
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Inserts the vehicles of all trips that are due, as far as there is room. Vehicles without room stay in the backlog.
void insert_trips(const Model& model, State& state);

}  // namespace stopline
