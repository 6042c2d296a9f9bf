// Full dynamics: reaction to leaders that a diverging vehicle hides.
#pragma once

#include "sim/perception/look_ahead.h"

namespace stopline {

// Adds braking demands for a stopped or slow vehicle on the own route that a diverging leader hides. Covers the
// vehicles of one lane. `hidden`: the hidden leader of the first vehicle; slot -1: none.
void react_to_hidden_leaders(const Model& model, const State& state, int lane, const LeaderAhead& hidden,
                             Partition& part);

}  // namespace stopline
