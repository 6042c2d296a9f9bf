// One look for a population in all figures of a run, and for the vehicles of the policy of that name: its place in the scenario, whoever
// is drawn beside it.
#pragma once

#include <string>

#include "experiment/gnuplot.h"
#include "scenario/scenario.h"

namespace stopline {

// Of a population or a policy. Policies that no population is named after come behind the populations.
LineStyle style_of(const Scenario& scenario, const std::string& name);

}  // namespace stopline
