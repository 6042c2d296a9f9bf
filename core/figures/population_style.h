// Line style of a population or a policy. Each policy of the paper has a style of its own, which is the same in all
// figures with one line for each population. Other names get the remaining styles, in the order in which the scenario
// or the sweep lists them.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "figures/gnuplot.h"
#include "scenario/scenario.h"

namespace stopline {

// Returns the index of the style for line_style(). `names` are all names that need a style.
std::size_t style_index(const std::vector<std::string>& names, const std::string& name);

// Returns the names of the populations of a scenario, followed by the names of the policies in mixed populations.
std::vector<std::string> styled_names(const Scenario& scenario);

LineStyle style_of(const Scenario& scenario, const std::string& name);

}  // namespace stopline
