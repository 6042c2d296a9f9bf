// Full dynamics: reaction to vehicles that a diverging leader hides.
#pragma once

#include "sim/perception/look_ahead.h"

namespace stopline {

// Adds braking demands to vehicles of a lane that cannot see a slow or stopped vehicle on their route. The leader of
// such a vehicle hides the slow vehicle: the leader is nearer, but will leave the route. `hidden`: the vehicle that is
// hidden from the first vehicle of the lane; slot -1: none.
void react_to_hidden_leaders(const Model& model, const State& state, int lane, const LeaderAhead& hidden,
                             Partition& part);

}  // namespace stopline
