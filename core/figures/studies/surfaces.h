// Maps of throughput, travel time and density with the value in each cell, instead of the surfaces of Fig. 17 to 20 of
// the paper. Each metric is a column. The first rows are the populations, the next rows their changes against the
// first. All panels of a metric share one colour scale, so that rows can be compared.
#pragma once

#include "figures/gnuplot.h"
#include "figures/studies/planes.h"

namespace stopline {

// Draws the maps. The sweep must have an x axis and a line axis.
Figure sweep_surfaces_figure(const SweepPlanes& all, const SweepPlane& plane, std::size_t number);

}  // namespace stopline
