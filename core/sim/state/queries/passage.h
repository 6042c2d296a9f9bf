// Times and records of passing fronts.
#pragma once

#include "sim/state/state.h"

namespace stopline {

// Returns the time at which a front passed `line_m` within the last step, from the vehicle's mean speed in that step.
double passing_time_s(const Model& model, const State& state, int slot, double line_m);

// Records that a vehicle goes from one lane to another. Lane -1 stands for outside the network.
void record_passage(RunRecords& records, const VehicleArrays& vehicles, double time_s, int slot, int from, int to);

// Records the start or end of a trip as a crossing of a detector. Does nothing if the detector is -1.
void record_trip_crossing(RunRecords& records, const VehicleArrays& vehicles, double time_s, int slot, int detector);

}  // namespace stopline
