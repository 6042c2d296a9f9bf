// Throughput, travel time and density of a sweep over several intersections as lines. A second row of panels shows the
// change against the first population (Fig. 17 to 20 of the paper; surfaces.h draws the same as maps).
#pragma once

#include "figures/gnuplot.h"
#include "figures/studies/planes.h"

namespace stopline {

// Draws one line for each population (colour) and each value of the line axis (dash and point). Whiskers show the
// minimum and maximum of several seeds.
Figure sweep_lines_figure(const SweepPlanes& all, const SweepPlane& plane, std::size_t number);

}  // namespace stopline
