// Time-space diagrams of a street, with one panel for each population (Fig. 16 of the paper).
#pragma once

#include <string>
#include <vector>

#include "figures/gnuplot.h"
#include "runs/network/network.h"
#include "runs/network/time_space.h"

namespace stopline {

// Draws `traces[k]` as the panel of `populations[k]`.
Figure time_space_figure(const Scenario& scenario, const std::vector<std::string>& populations,
                         const std::vector<StreetTrace>& traces);

// Draws the panels of all populations of a report.
Figure time_space_figure(const NetworkReport& report);

}  // namespace stopline
