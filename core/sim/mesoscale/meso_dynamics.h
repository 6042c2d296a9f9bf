// Mesoscale mode: moves vehicles by one step with the car-following models of their policies
// (driver/following_model.h). Every vehicle reacts to the state at the beginning of the step.
#pragma once

#include <cstdint>

#include "sim/mesoscale/meso_kernels.h"
#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Returns the highest speed for the next step from which the vehicle in `slot` can still stop comfortably within
// `room_m`. The result is at least the speed after one step of maximum braking.
double stopping_speed_mps(const Model& model, const VehicleArrays& v, int slot, double room_m);

// Returns the speed for the next step of a vehicle without a leader. The speed approaches `limit_mps` times
// Model::leader_speed_share. A vehicle above this product brakes to it with DriverTables::deceleration_mps2.
double leading_speed_mps(const Model& model, int policy, double speed_mps, double limit_mps);

// Return the arguments of the kernels. `prefetches`: see MesoStep.
MesoStreams meso_streams(VehicleArrays& vehicles);
MesoStep meso_step(const Model& model, std::int64_t tick, bool prefetches = false);

// Moves the vehicles of `part.moving_blocks` by one step. collect_moving_blocks() must have listed these blocks.
void step_meso(const Model& model, State& state, Partition& part);

}  // namespace stopline
