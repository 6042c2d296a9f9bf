// Checks of vehicles, drivers and policies that compare several parts of a scenario. Vehicles must be able to keep
// their gaps. Parameters should not be used beyond the data from which they were made.
#pragma once

#include <string>
#include <vector>

#include "scenario/scenario.h"
#include "scenario/schema/report.h"

namespace stopline {

// The smallest standstill gap in full dynamics, m. In a chain of vehicles that stop as hard as they can, a follower
// uses up to 1.3 m of its gap, because its brakes respond later than its leader's (measured in
// tests/sim/full_dynamics/hard_stop_test.cpp). Emergency braking keeps another 0.5 m (default of
// driver.cacc.emergency_gap). Both together are less than 2 m.
inline constexpr double kMinStandstillGap_m = 2.0;

// Checks the policies that the populations use. In full dynamics, also checks the tyres and the lags of brake and drive
// torque. In the mesoscale mode, also checks the distances that vehicles keep to stop lines and conflict areas.
void check_gaps(const Scenario& scenario, Checker& check);

// Returns one line for each parameter set that the scenario uses beyond its range. Full dynamics: the speed limits of
// the network exceed the range of the driver's acceleration profile. Mesoscale mode: the speed limits exceed the one
// for which the car-following models were calibrated; or the time step exceeds the calibrated one, and a population
// uses a policy with another law than constant_time.
std::vector<std::string> range_warnings(const Scenario& scenario);

}  // namespace stopline
