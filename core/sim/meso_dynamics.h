// A step of the mesoscale mode: car following of the Krauss family (driver/krauss.h), every vehicle from the state at the beginning
// of the step.
#pragma once

#include "sim/model.h"
#include "sim/state.h"

namespace stopline {

// Highest speed from which a vehicle stops in the room it has; it brakes no harder than its brakes can.
double stopping_speed_mps(const Model& model, const VehicleArrays& v, int slot, double room_m);

// The speed in the next step of a first vehicle without predecessor, on the way to what it drives at most.
double leading_speed_mps(const Model& model, double speed_mps, double limit_mps);

// One step of the vehicles on some lanes, which the part's scratch must have room for; lanes in the order of their slots.
void step_meso(const Model& model, const LaneGroup& lanes, State& state, NetworkPart& part);

}  // namespace stopline
