// Speed advice of signals (green light optimal speed advisory, GLOSA). A signal announces its next green. The first
// vehicle of an approach lane that would arrive too early slows down so that it arrives at green without a stop.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Sets speed targets for the vehicles of a partition that get speed advice. Reads the signals of the present tick.
void advise_speeds(const Model& model, State& state, Partition& part);

// Returns the speed with which a vehicle covers `distance_m` in exactly `time_s`, after it has braked to this speed
// with a constant deceleration. Returns distance_m / time_s if the vehicle need not brake. Returns 0 if braking with
// this deceleration is too weak for a late enough arrival.
double speed_for_arrival_mps(double speed_mps, double distance_m, double time_s, double deceleration_mps2);

}  // namespace stopline
