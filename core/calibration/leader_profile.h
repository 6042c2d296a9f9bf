// Acceleration of platoon leaders over speed, measured in full dynamics for the mesoscale mode. A single vehicle starts
// at a signal. The speeds are divided into bins. The acceleration of a bin is the mean acceleration while the speed of
// the vehicle rises from the lower to the upper end of the bin. Gear changes in this time are included.
#pragma once

#include "scenario/scenario.h"

namespace stopline {

// Sets leader_profile_mps (speeds in the middle of the bins) and leader_profile_mps2 (accelerations of the bins). Only
// the vehicle and driver of `scenario` are used.
void measure_leader_profile(const Scenario& scenario, MesoSettings& settings);

}  // namespace stopline
