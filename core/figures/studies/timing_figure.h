// Figure of a search over signal times: the objective for each pair of two times, as a map with the value in each cell.
#pragma once

#include "figures/gnuplot.h"
#include "signal_timing/timing_search.h"

namespace stopline {

// Returns the map of a search, named search_POPULATION. The x axis is the green of the streets from west to east. The
// y axis is the offset if the search has several offsets, else the green of the streets from south to north. Each cell
// shows the best value over the third time.
Figure timing_figure(const TimingSearch& search);

}  // namespace stopline
