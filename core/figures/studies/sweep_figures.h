// Figures of a sweep over the green times and offsets of several intersections: throughput, travel time and density,
// their change against the first population (Fig. 17 to 20 of the paper), and stability (Fig. 21). The figures need
// only the results table.
#pragma once

#include <string>
#include <vector>

#include "base/io/csv.h"
#include "figures/gnuplot.h"
#include "sweeps/sweep.h"

namespace stopline {

// Returns true if the table has the axes `green`, `offset` and `population` and the metrics of several intersections.
bool is_network_sweep(const CsvTable& results);

// Returns the figures of a results table: network_N (lines), surfaces_N (maps of the metrics) and stability_N (maps of
// stability). planes.h says which axes of the sweep are drawn. N numbers the combinations of values of all other axes,
// and the titles show these values. Results are means over seeds, with minimum and maximum. If only one axis varies,
// surfaces_N is left out. Returns an empty list if the results are not those of several intersections, or if
// sweep_planes() returns nothing.
std::vector<Figure> network_sweep_figures(const CsvTable& results, const CellTitles& titles,
                                          const std::string& population_column = "population");

// Returns a note to the user if the sweep lacks the axis `green` or `offset`. The note names the required columns, and
// the axes that the figures use instead. Returns an empty text if both axes exist, or if the results are not those of
// several intersections.
std::string network_sweep_note(const CsvTable& results, const CellTitles& titles,
                               const std::string& population_column = "population");

}  // namespace stopline
