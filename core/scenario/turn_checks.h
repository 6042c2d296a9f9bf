// Whether the lanes of a network serve the shares of turns that the demand asks for.
#pragma once

#include "scenario/report.h"
#include "scenario/scenario.h"

namespace stopline {

void check_turns(const Scenario& scenario, Checker& check);

}  // namespace stopline
