// Figure of the report by the Highway Capacity Manual: headways by position in the queue, and the measured control
// delay of each lane beside the formula.
#pragma once

#include <optional>
#include <vector>

#include "figures/gnuplot.h"
#include "runs/hcm/hcm_tables.h"

namespace stopline {

// Returns nothing if no lane has a delay.
std::optional<Figure> hcm_figure(const std::vector<PopulationHcm>& populations);

}  // namespace stopline
