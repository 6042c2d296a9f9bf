// Figures of energy, comfort and safety, for all kinds of networks.
#pragma once

#include <vector>

#include "figures/gnuplot.h"
#include "runs/driving/driving_csv.h"
#include "scenario/scenario.h"

namespace stopline {

// Returns the figures of the measures that the scenario asks for.
std::vector<Figure> driving_figures(const Scenario& scenario, const std::vector<PopulationDriving>& populations);

}  // namespace stopline
