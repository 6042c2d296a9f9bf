// Line style of a population in all figures of a run. The style depends on the position of the population in the
// scenario. So a population keeps its style in a figure that shows only some of the populations. In a figure that shows
// vehicles by policy, a policy has the style of the population with the same name.
#pragma once

#include <string>

#include "figures/gnuplot.h"
#include "scenario/scenario.h"

namespace stopline {

// Returns the style of a population or a policy. A policy without a population of its name gets one of the styles after
// those of the populations.
LineStyle style_of(const Scenario& scenario, const std::string& name);

}  // namespace stopline
