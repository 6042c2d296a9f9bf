// Fig. 23 of the paper. The figure plots the throughput gain of the populations CDG and MIX over CTG-Ref against the
// green time, on the grid, on the arterial and at a single intersection.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "figures/gnuplot.h"
#include "paper/measurements.h"

namespace stopline {

// Returns the figure, or an empty list if neither the grid nor the arterial was measured. `measured` maps the name of
// each scorecard experiment to its measurements.
std::vector<Figure> comparison_figure(const std::map<std::string, Measurements>& measured);

}  // namespace stopline
