// Checks that the lanes of a network allow the turns of the demand.
#pragma once

#include "scenario/scenario.h"
#include "scenario/schema/report.h"

namespace stopline {

void check_turns(const Scenario& scenario, Checker& check);

}  // namespace stopline
