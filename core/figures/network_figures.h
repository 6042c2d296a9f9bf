// Figures of one run over several intersections.
#pragma once

#include "figures/gnuplot.h"
#include "runs/network/network.h"

namespace stopline {

// Draws throughput, travel time, density and the number of teleported vehicles over time (Fig. 22 of the paper).
Figure network_series_figure(const NetworkReport& report);

// Draws the causes for which vehicles are stopped. The share of a cause is its part of the total stopped time.
Figure delay_causes_figure(const NetworkReport& report);

}  // namespace stopline
