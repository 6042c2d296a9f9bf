// Figures of a sweep over the green times and offsets of several intersections: throughput, travel time and density,
// their change against the first population (Fig. 17 to 20 of the paper), and stability (Fig. 21). They need only the
// results table.
#pragma once

#include <string>
#include <vector>

#include "base/io/csv.h"
#include "figures/gnuplot.h"
#include "sweeps/sweep.h"

namespace stopline {

// Returns true if the table has the axes green, offset and population and the metrics of several intersections.
bool is_network_sweep(const CsvTable& results);

// Returns three figures for each combination of the other axes: network_N (lines), surfaces_N (maps) and stability_N.
// The title names the combination. Values are means over seeds, with minimum and maximum. planes.h says how the axes of
// the figures are chosen. Returns nothing for a table that is not of several intersections. There are no maps with one
// axis only.
std::vector<Figure> network_sweep_figures(const CsvTable& results, const CellTitles& titles,
                                          const std::string& population_column = "population");

// Returns a note to the user of a sweep without the axes green and offset: the required column names, and the axes that
// are drawn instead. Returns an empty text if both axes exist.
std::string network_sweep_note(const CsvTable& results, const CellTitles& titles,
                               const std::string& population_column = "population");

}  // namespace stopline
