// Figure of a sweep as lines, with one column of panels for each metric. A second row of panels shows the change
// against the baseline (Fig. 17 to 20 of the paper). surfaces.h draws the same values as maps.
#pragma once

#include "figures/gnuplot.h"
#include "figures/studies/planes.h"

namespace stopline {

// Draws the figure lines_`number`, which has the name network_`number` for several intersections. Each population has a
// colour. Each value of the line axis (see planes.h) has a dash and a point. With three or more seeds, whiskers show
// the 95 % confidence interval.
Figure sweep_lines_figure(const SweepPlanes& all, const SweepPlane& plane, std::size_t number);

}  // namespace stopline
