// How platoon leaders accelerate, measured in full dynamics for the mesoscale mode: a lone vehicle sets out at a light, and each bin of
// speed gets the mean acceleration from its lower to its upper end, gear changes included. Nothing about it is fitted.
#pragma once

#include "scenario/scenario.h"

namespace stopline {

// Sets leader_profile_mps (middles of bins) and leader_profile_mps2. `scenario` gives vehicle and driver; its network and limits do not matter.
void measure_leader_profile(const Scenario& scenario, MesoSettings& settings);

}  // namespace stopline
