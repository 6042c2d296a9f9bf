// A step of the mesoscale mode: car following of the Krauss family (driver/krauss.h), every vehicle from the state at the beginning
// of the step.
#pragma once

#include <span>

#include "sim/model.h"
#include "sim/state.h"

namespace stopline {

// Highest speed from which a vehicle stops in the room it has; it brakes no harder than its brakes can.
double stopping_speed_mps(const Model& model, const VehicleArrays& v, int slot, double room_m);

// One step of the vehicles on some lanes, which state.meso_group must have room for; lanes in any order.
void step_meso(const Model& model, std::span<const LaneStep> lanes, State& state);

}  // namespace stopline
