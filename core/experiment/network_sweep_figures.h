// What a sweep over greens and offsets of several intersections shows: throughput, travel time and density, the improvement over the
// first population (Fig. 17 to 20 of the paper), and where traffic is stable (Fig. 21). Read from the table of results.
#pragma once

#include <vector>

#include "experiment/csv.h"
#include "experiment/gnuplot.h"
#include "experiment/sweep.h"

namespace stopline {

// Whether the table has the axes green, offset and population, and the metrics of several intersections.
bool is_network_sweep(const CsvTable& results);

// Two figures for each combination of the other axes, network_1 and stability_1, ..., with those as their title. Means over seeds; of
// stabilities the worst.
std::vector<Figure> network_sweep_figures(const CsvTable& results, const CellTitles& titles);

}  // namespace stopline
