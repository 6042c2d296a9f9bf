// Safety of inserting a vehicle behind an intersection.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Returns true if a vehicle on its way to a lane could not stop behind a vehicle inserted there. `rear_m`: rear of the
// inserted vehicle, from the start of the lane.
bool approaching_vehicle_cannot_stop(const Model& model, const State& state, int lane, double rear_m = 0.0);

}  // namespace stopline
