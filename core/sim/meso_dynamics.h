// A step of the mesoscale mode: car following of the Krauss family (driver/krauss.h), every vehicle from the state at the beginning
// of the step.
#pragma once

#include <cstdint>

#include "sim/meso_kernels.h"
#include "sim/model.h"
#include "sim/state.h"

namespace stopline {

// Highest speed from which a vehicle stops in the room it has; it brakes no harder than its brakes can.
double stopping_speed_mps(const Model& model, const VehicleArrays& v, int slot, double room_m);

// The speed in the next step of a first vehicle without predecessor, on the way to what it drives at most.
double leading_speed_mps(const Model& model, double speed_mps, double limit_mps);

// What the kernels take.
MesoStreams meso_streams(VehicleArrays& vehicles);
MesoStep meso_step(const Model& model, std::int64_t tick, bool fetches = false);

// One step of the vehicles of the part, those that collect_moves() found.
void step_meso(const Model& model, State& state, NetworkPart& part);

}  // namespace stopline
