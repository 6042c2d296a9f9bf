// Teleporting: removes a blocked vehicle and reinserts it behind the intersection (TrafficRules).
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Removes the first vehicle of a lane, to be reinserted behind the intersection. Returns false if the vehicle is behind
// its last intersection already, or if there is no free slot.
bool remove_for_teleport(const Model& model, State& state, int lane);

// Reinserts teleported vehicles where there is room, and removes vehicles that have been stopped for too long at the
// head of a lane.
void teleport_blocked_vehicles(const Model& model, State& state);

}  // namespace stopline
