// Maps of stability over the two axes of a sweep (Fig. 21 of the paper), one for each population.
#pragma once

#include "figures/gnuplot.h"
#include "figures/studies/planes.h"

namespace stopline {

// Draws in each cell the worst stability of all seeds. With several seeds, the cell also shows the share of seeds with
// this stability. If only one axis of the sweep varies, the populations are the second axis.
Figure sweep_stability_figure(const SweepPlanes& all, const SweepPlane& plane, std::size_t number);

}  // namespace stopline
