// Fig. 23 of the paper: by how much CDG and MIX improve throughput over CTG-Ref, over green, on the grid and the arterial beside the single
// intersection.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "experiment/gnuplot.h"
#include "experiment/measurements.h"

namespace stopline {

// From what the scorecard's experiments measured, by name. Empty where neither grid nor arterial was measured.
std::vector<Figure> comparison_figure(const std::map<std::string, Measurements>& measured);

}  // namespace stopline
