// Fig. 17 to 20 of the paper: its surfaces over green and offset, here as maps with the value in each cell. A column for each metric; a row for
// each population, then one for the change of each from the first. One colour scale a metric, so that rows can be compared.
#pragma once

#include "experiment/gnuplot.h"
#include "experiment/network_sweep_planes.h"

namespace stopline {

// Needs both axes.
Figure sweep_surfaces_figure(const SweepPlanes& all, const SweepPlane& plane, std::size_t number);

}  // namespace stopline
