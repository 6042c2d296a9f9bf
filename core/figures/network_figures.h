// Figures of the runs over a network of several intersections, one run for each population.
#pragma once

#include "figures/gnuplot.h"
#include "runs/network/network.h"

namespace stopline {

// Draws throughput, travel time, density and the number of teleported vehicles over time (Fig. 22 of the paper).
Figure network_series_figure(const NetworkReport& report);

// Draws for each population the causes that stop its vehicles, as shares of the total stopped time.
Figure delay_causes_figure(const NetworkReport& report);

}  // namespace stopline
