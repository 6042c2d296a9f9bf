// A drawing of streets to scale: lanes, where they lead, stop lines by signal group, and the programme of each intersection.
#pragma once

#include "experiment/gnuplot.h"
#include "scenario/scenario.h"

namespace stopline {

// Figure `network`. A corridor from west to east is split over several rows; arms that lead to the border are cut.
Figure street_map(const Scenario& scenario);

}  // namespace stopline
