// Computes and records when the front of a vehicle passes a position.
#pragma once

#include "sim/state/state.h"

namespace stopline {

// Returns the time in s at which the front of a vehicle passed position `line_m` in the present step. The mean speed of
// the vehicle in the step serves for interpolation.
double passing_time_s(const Model& model, const State& state, int slot, double line_m);

// Records that a vehicle passes from lane `from` to lane `to`. The index -1 means: outside the network.
void record_passage(RunRecords& records, const VehicleArrays& vehicles, double time_s, int slot, int from, int to);

// Records the start or end of a trip as a crossing of `detector`. Does nothing if `detector` is -1.
void record_trip_crossing(RunRecords& records, const VehicleArrays& vehicles, double time_s, int slot, int detector);

}  // namespace stopline
