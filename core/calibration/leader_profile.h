// Acceleration of platoon leaders over speed, measured in full dynamics for the mesoscale mode. A single vehicle starts
// at a signal. Each bin of speed gets the mean acceleration from its lower to its upper end, gear changes included.
#pragma once

#include "scenario/scenario.h"

namespace stopline {

// Sets leader_profile_mps (middles of the bins) and leader_profile_mps2. Only the vehicle and driver of `scenario` are
// used.
void measure_leader_profile(const Scenario& scenario, MesoSettings& settings);

}  // namespace stopline
