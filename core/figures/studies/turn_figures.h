// Results of a sweep over the green time and the turns of an intersection: throughput, travel time and density over the
// turn ratios (Fig. 9 of the paper, for every green), and the improvement beside Table 1. All need only the results
// table.
#pragma once

#include <string>
#include <vector>

#include "base/io/csv.h"
#include "figures/gnuplot.h"
#include "reference/targets.h"

namespace stopline {

// Returns true if the table has the axes green, left, right and population and the metrics of an intersection.
bool has_turns(const CsvTable& results);

// Returns one figure for each green time, named such as turns_green_15. Values are means over seeds.
std::vector<Figure> turn_figures(const CsvTable& results);

// Returns Table 1 as CSV: the value of the paper, ours, and the difference in percentage points. A field is empty if
// the results lack the point.
std::string table1_csv(const CsvTable& results, const std::vector<Target>& targets);

// Check of two statements of Section IV on mean throughputs: throughput falls with more turns, and it grows more than
// in proportion to the share of CDG. A point of a mixed population then lies below the straight line between CTG-Ref
// and CDG.
struct Orders {
    int steps = 0;  // steps to the next larger share of left or right turns, all greens and populations
    int rises = 0;  // steps in which throughput rises
    double largest_rise_percent = 0.0;
    std::string largest_rise;  // population, green and turns of the largest rise
    int points = 0;            // points of mixed populations, all greens and turns
    int above_line = 0;        // points above the straight line
};
Orders orders_of(const CsvTable& results);

}  // namespace stopline
