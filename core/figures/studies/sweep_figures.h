// Figures of a sweep: three metrics over the axes of the sweep, and their change against the baseline. Sweeps over
// several intersections show throughput, travel time and density (Fig. 17 to 20 of the paper) and stability (Fig. 21).
// The figures need only the results table.
#pragma once

#include <string>
#include <vector>

#include "base/io/csv.h"
#include "figures/gnuplot.h"
#include "sweeps/sweep.h"

namespace stopline {

// Returns true if the table has the axes `green`, `offset` and `population` and the metrics of several intersections.
bool is_network_sweep(const CsvTable& results);

// Returns the figures of a results table: lines_N, surfaces_N (maps of the metrics) and stability_N (maps of
// stability). For several intersections, lines_N has the name network_N. planes.h says which axes of the sweep are
// drawn. N numbers the combinations of values of all other axes, and the titles show these values. Results are means
// over seeds. lines_N also has their 95 % confidence intervals. If only one axis varies, surfaces_N is left out.
// stability_N exists for several intersections only. Returns an empty list if sweep_metrics() or sweep_planes() returns
// nothing. `baseline` is the population with which the others are compared; empty: the first one.
std::vector<Figure> sweep_figures(const CsvTable& results, const CellTitles& titles,
                                  const std::string& population_column = "population",
                                  const std::string& baseline = "");

// Returns a note to the user if the sweep lacks the axis `green` or `offset`. The note names the required columns, and
// the axes that the figures use instead. Returns an empty text if both axes exist, or if the results are not those of
// several intersections.
std::string sweep_figures_note(const CsvTable& results, const CellTitles& titles,
                               const std::string& population_column = "population");

}  // namespace stopline
