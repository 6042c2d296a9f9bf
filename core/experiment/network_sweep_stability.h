// Where traffic is stable, Fig. 21 of the paper: a map of each population.
#pragma once

#include "experiment/gnuplot.h"
#include "experiment/network_sweep_planes.h"

namespace stopline {

// A cell shows the worst of the seeds, and of several how many were so. Where there is one axis only, populations are the other.
Figure sweep_stability_figure(const SweepPlanes& all, const SweepPlane& plane, std::size_t number);

}  // namespace stopline
