// Map of streets to scale: lanes with their movements, stop lines by signal group, and the signal programme of each
// intersection.
#pragma once

#include "figures/gnuplot.h"
#include "scenario/scenario.h"

namespace stopline {

// Draws the figure `network`. A long corridor from west to east is split into several rows. Legs that lead to the
// border of the network are shortened.
Figure street_map(const Scenario& scenario);

}  // namespace stopline
