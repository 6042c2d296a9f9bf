// What a sweep over greens and offsets of several intersections shows: throughput, travel time and density, the improvement over the
// first population (Fig. 17 to 20 of the paper), and where traffic is stable (Fig. 21). Read from the table of results.
#pragma once

#include <string>
#include <vector>

#include "experiment/csv.h"
#include "experiment/gnuplot.h"
#include "experiment/sweep.h"

namespace stopline {

// Whether the table has the axes green, offset and population, and the metrics of several intersections.
bool is_network_sweep(const CsvTable& results);

// Figures for each combination of the other axes, with those as their title: network_1 (lines), surfaces_1 (maps, where both axes have two
// values) and stability_1, ... Means over seeds, with the least and the greatest. Where green and offset are no axes, those are drawn over that
// are numbers, if there are no more than two (network_sweep_planes.h). None for tables of anything but several intersections.
std::vector<Figure> network_sweep_figures(const CsvTable& results, const CellTitles& titles,
                                          const std::string& population_column = "population");

// One line for the user of a sweep over several intersections without the axes green and offset: what they must be called, and what is drawn
// instead. Empty where there is nothing to say.
std::string network_sweep_note(const CsvTable& results, const CellTitles& titles,
                               const std::string& population_column = "population");

}  // namespace stopline
