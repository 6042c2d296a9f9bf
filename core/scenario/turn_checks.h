// Checks that the turn shares of the demand fit the movements that the lanes of the network allow.
#pragma once

#include "scenario/scenario.h"
#include "scenario/schema/report.h"

namespace stopline {

void check_turns(const Scenario& scenario, Checker& check);

}  // namespace stopline
