// Inserts vehicles at inlets: from an endless backlog, at given headways, or as queues before the first step. An inlet
// is a lane on which vehicles enter the network (DemandPlan::Inlet).
#pragma once

#include <cstdint>

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Inserts a queue at every inlet before the first step if the demand asks for it (DemandPlan::starts_queued).
void insert_initial_queues(const Model& model, State& state);

// Inserts the next vehicle of each inlet if the vehicle is due and has room.
void insert_vehicles(const Model& model, State& state);

// Returns the number of vehicles that are due but have found no room to enter. Counts only vehicles on trips, and
// vehicles of inlets where vehicles arrive at a constant headway (DemandPlan::is_evenly_spaced()).
std::int64_t insertion_backlog(const Model& model, const State& state);

}  // namespace stopline
