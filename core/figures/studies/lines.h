// Figure of a sweep over several intersections: throughput, travel time and density as lines. A second row of panels
// shows the change against the first population (Fig. 17 to 20 of the paper). surfaces.h draws the same values as maps.
#pragma once

#include "figures/gnuplot.h"
#include "figures/studies/planes.h"

namespace stopline {

// Draws the figure network_`number`. Each population has a colour. Each value of the line axis (see planes.h) has a
// dash and a point. With several seeds, whiskers show minimum and maximum.
Figure sweep_lines_figure(const SweepPlanes& all, const SweepPlane& plane, std::size_t number);

}  // namespace stopline
