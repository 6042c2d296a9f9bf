// Inserts vehicles at inlets: from an endless backlog, at given headways, or as queues before the first step. An inlet
// is a lane on which vehicles enter the network (DemandPlan::Inlet).
#pragma once

#include <cstdint>

#include "sim/state/insertion_state.h"
#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Inserts a queue at every inlet before the first step if the demand asks for it (DemandPlan::starts_queued).
void insert_initial_queues(const Model& model, State& state);

// Inserts the next vehicle of each inlet if the vehicle is due and has room.
void insert_vehicles(const Model& model, State& state);

// Returns the number of vehicles that are due but have found no room to enter. Counts only vehicles that have an
// arrival time: vehicles on trips, and those of inlets with DemandPlan::forms_backlog().
std::int64_t insertion_backlog(const Model& model, const State& state);

// Returns the departure delays of all vehicles that have arrived. A vehicle of the backlog has waited until now. Counts
// only vehicles that have an arrival time.
DepartureDelays departure_delays(const Model& model, const State& state);
// Returns the departure delays of one inlet.
DepartureDelays departure_delays(const Model& model, const State& state, int inlet);

}  // namespace stopline
