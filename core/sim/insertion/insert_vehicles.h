// Inserts vehicles at inlets: saturated, at a rate, or in a queue before the first step.
#pragma once

#include <cstdint>

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Inserts the queues that the demand asks for before the first step.
void insert_initial_queues(const Model& model, State& state);

// Inserts the vehicles that are due and have room.
void insert_vehicles(const Model& model, State& state);

// Returns the number of vehicles that are due and have found no room: trips, and vehicles of inlets with even headways.
std::int64_t insertion_backlog(const Model& model, const State& state);

}  // namespace stopline
