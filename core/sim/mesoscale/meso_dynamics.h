// A step of the mesoscale mode: car following of the Krauss family (driver/krauss.h). Every vehicle reacts to the state
// at the beginning of the step.
#pragma once

#include <cstdint>

#include "sim/mesoscale/meso_kernels.h"
#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Returns the highest next speed from which a vehicle still stops within `room_m`. The result never asks for more than
// maximum braking.
double stopping_speed_mps(const Model& model, const VehicleArrays& v, int slot, double room_m);

// Returns the next speed of a vehicle without a leader. It approaches the leader's share of the limit (Model).
double leading_speed_mps(const Model& model, double speed_mps, double limit_mps);

// Return the arguments of the kernels. `prefetches`: see MesoStep.
MesoStreams meso_streams(VehicleArrays& vehicles);
MesoStep meso_step(const Model& model, std::int64_t tick, bool prefetches = false);

// Moves the vehicles that collect_moving_blocks() selected by one step.
void step_meso(const Model& model, State& state, Partition& part);

}  // namespace stopline
