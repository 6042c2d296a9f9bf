// Fig. 23 of the paper: throughput gain of CDG and MIX over CTG-Ref, over green, on grid, arterial and single
// intersection.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "figures/gnuplot.h"
#include "paper/measurements.h"

namespace stopline {

// Draws the measurements of the scorecard's experiments, given by name. Returns nothing without grid and arterial.
std::vector<Figure> comparison_figure(const std::map<std::string, Measurements>& measured);

}  // namespace stopline
