// Throughput, travel time and density of a sweep over several intersections as lines, and below them the changes from the first population
// (Fig. 17 to 20 of the paper, whose surfaces are in network_sweep_surfaces.h).
#pragma once

#include "experiment/gnuplot.h"
#include "experiment/network_sweep_planes.h"

namespace stopline {

// Colour: population; dash and point: value of the axis of the lines. Whiskers from the least to the greatest where there are several seeds.
Figure sweep_lines_figure(const SweepPlanes& all, const SweepPlane& plane, std::size_t number);

}  // namespace stopline
