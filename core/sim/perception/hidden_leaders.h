// Full dynamics: reaction to vehicles that a diverging leader hides.
#pragma once

#include "sim/perception/look_ahead.h"

namespace stopline {

// Adds braking demands on those vehicles of `lane` whose leader hides a slow or stopped vehicle on their route. The
// leader is nearer than the hidden vehicle, but will leave the route. `hidden`: the vehicle that is hidden from the
// first vehicle of the lane; slot -1: none.
void react_to_hidden_leaders(const Model& model, const State& state, int lane, const LeaderAhead& hidden,
                             Partition& part);

}  // namespace stopline
