// Maps of the metrics with the value in each cell, instead of the surfaces of Fig. 17 to 20 of the paper. Each metric
// has a column of panels. The upper rows show the values of each population, the lower rows the changes against the
// baseline. In each column, all panels with values share one colour scale, and all panels with changes share another
// one.
#pragma once

#include "figures/gnuplot.h"
#include "figures/studies/planes.h"

namespace stopline {

// Draws the figure surfaces_`number`. The sweep must have an x axis and a line axis.
Figure sweep_surfaces_figure(const SweepPlanes& all, const SweepPlane& plane, std::size_t number);

}  // namespace stopline
