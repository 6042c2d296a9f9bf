// Safety check before a vehicle is inserted just downstream of an intersection.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Returns true if an approaching vehicle could not stop behind a vehicle inserted on `lane`. Only checks vehicles that
// are still upstream of the lane. `rear_m`: rear of the inserted vehicle, from the start of the lane.
bool approaching_vehicle_cannot_stop(const Model& model, const State& state, int lane, double rear_m = 0.0);

}  // namespace stopline
