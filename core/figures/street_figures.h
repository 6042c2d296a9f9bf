// Figures of runs over streets that a user describes (Fig. 25 and 26 of the paper).
#pragma once

#include "figures/gnuplot.h"
#include "runs/network/network.h"

namespace stopline {

// Draws the inflow from west, from east and from the crossing streets over time.
Figure inflow_figure(const NetworkReport& report);

// Draws mean speeds over position and time in both directions. Queues show as dark areas.
Figure backlog_figure(const NetworkReport& report);

}  // namespace stopline
