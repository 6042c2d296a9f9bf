// Time-space diagrams of a street, a panel for each population (Fig. 16 of the paper).
#pragma once

#include <string>
#include <vector>

#include "figures/gnuplot.h"
#include "runs/network/network.h"
#include "runs/network/time_space.h"

namespace stopline {

// Draws one panel for each population.
Figure time_space_figure(const Scenario& scenario, const std::vector<std::string>& populations,
                         const std::vector<StreetTrace>& traces);

// The same for the populations of a report.
Figure time_space_figure(const NetworkReport& report);

}  // namespace stopline
