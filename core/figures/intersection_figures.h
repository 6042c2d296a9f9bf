// Figures of the runs at one intersection: a picture of one moment (Fig. 8 of the paper) and headways by queue
// position.
#pragma once

#include <vector>

#include "figures/gnuplot.h"
#include "runs/intersection/intersection.h"

namespace stopline {

// Draws the network to scale with the vehicles of one population at the time of the snapshot
// (IntersectionResult::snapshot_s). The colour of a vehicle shows its policy.
Figure intersection_picture(const IntersectionReport& report, std::size_t population);

// Returns the picture of the population with the most even mix of policies, and the headways by queue position if there
// are enough samples.
std::vector<Figure> intersection_figures(const IntersectionReport& report);

}  // namespace stopline
