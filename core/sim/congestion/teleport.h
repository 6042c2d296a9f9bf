// Teleports vehicles that are blocked (TrafficRules::teleport_cycles) or have missed their turn: removes them and
// reinserts them downstream of the intersection.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Removes the first vehicle of a lane. This vehicle will be reinserted downstream of the intersection ahead. Returns
// false if no intersection is ahead of the vehicle, or if the list of removed vehicles is full.
bool remove_for_teleport(const Model& model, State& state, int lane);

// Reinserts the removed vehicles for which there is room. Then removes the first vehicle of each lane if this vehicle
// has been stopped for RulesPlan::teleport_ticks or longer.
void teleport_blocked_vehicles(const Model& model, State& state);

}  // namespace stopline
