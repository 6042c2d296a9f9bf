// Teleports blocked vehicles: removes them and reinserts them downstream of the intersection (TrafficRules).
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Removes the first vehicle of a lane, which will be reinserted downstream of the intersection ahead. Returns false if
// no intersection is ahead of the vehicle, or if there is no free slot.
bool remove_for_teleport(const Model& model, State& state, int lane);

// Reinserts teleported vehicles that have room. Then removes the first vehicle of each lane if it has been stopped for
// too long.
void teleport_blocked_vehicles(const Model& model, State& state);

}  // namespace stopline
