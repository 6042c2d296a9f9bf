// Maps of stability over the two axes of a sweep (Fig. 21 of the paper), one for each population.
#pragma once

#include "figures/gnuplot.h"
#include "figures/studies/planes.h"

namespace stopline {

// Draws the worst result of all seeds in each cell and, with several seeds, the number of seeds that had it. If the
// sweep has one varied axis only, the populations are the second axis.
Figure sweep_stability_figure(const SweepPlanes& all, const SweepPlane& plane, std::size_t number);

}  // namespace stopline
