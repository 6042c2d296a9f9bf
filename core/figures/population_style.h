// Line style of a population in all figures of a run. It depends on the position of the population in the scenario, so
// it does not change with the populations that a figure shows. Vehicles of a policy have the style of the population of
// that name.
#pragma once

#include <string>

#include "figures/gnuplot.h"
#include "scenario/scenario.h"

namespace stopline {

// Returns the style of a population or a policy. Policies without a population of their name follow the populations.
LineStyle style_of(const Scenario& scenario, const std::string& name);

}  // namespace stopline
