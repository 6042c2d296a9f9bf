// Full dynamics: reaction to vehicles that a diverging leader hides.
#pragma once

#include "sim/perception/look_ahead.h"

namespace stopline {

// Adds braking demands on the vehicles of a lane whose leader diverges from their route and hides a slow or stopped
// vehicle on it. `hidden`: the vehicle that is hidden from the first vehicle of the lane; slot -1: none.
void react_to_hidden_leaders(const Model& model, const State& state, int lane, const LeaderAhead& hidden,
                             Partition& part);

}  // namespace stopline
