// Checks of vehicles, drivers and policies that compare several parts of a scenario. Vehicles must be able to keep
// their gaps. Parameters should not be used beyond the data from which they were made.
#pragma once

#include <string>
#include <vector>

#include "scenario/scenario.h"
#include "scenario/schema/report.h"

namespace stopline {

// The smallest standstill gap in full dynamics, m. In a chain of vehicles that stop as hard as they can, a follower
// uses up to 1.3 m of its gap, because its brakes respond later than its leader's. Emergency braking keeps
// driver.cacc.emergency_gap (0.5 m by default). tests/sim/full_dynamics/hard_stop_test.cpp measures the loss.
inline constexpr double kMinStandstillGap_m = 2.0;

// Checks the policies that the populations use, the tyres, and the lags of brake and drive torque.
void check_gaps(const Scenario& scenario, Checker& check);

// Returns one line for each parameter set that is used beyond its range: speed limits of the driver or of the mesoscale
// models, and the step of the mesoscale models.
std::vector<std::string> range_warnings(const Scenario& scenario);

}  // namespace stopline
