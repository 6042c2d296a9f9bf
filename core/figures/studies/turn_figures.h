// Results of a sweep over the green time and the turn ratios of an intersection: throughput, travel time and density
// over the turn ratios (Fig. 9 of the paper, for every green time). A table lists the improvements of Table 1 of the
// paper beside our improvements. The figures need only the results table.
#pragma once

#include <string>
#include <vector>

#include "base/io/csv.h"
#include "figures/gnuplot.h"
#include "reference/targets.h"

namespace stopline {

// Returns true if the table has the axes `green`, `left`, `right` and `population` and the metrics of a single
// intersection.
bool has_turns(const CsvTable& results);

// Returns one figure for each green time, named such as turns_green_15. Values are means over seeds.
std::vector<Figure> turn_figures(const CsvTable& results);

// Returns Table 1 as CSV: the value of the paper, ours, and the difference in percentage points. Our value is empty if
// the results lack the combination of population, green and turns.
std::string table1_csv(const CsvTable& results, const std::vector<Target>& targets);

// Check of two statements of Section IV on mean throughput. First, throughput falls with the share of turns. Second,
// throughput grows more than in proportion to the share of CDG: at equal green and turns, the throughput of a mixed
// population lies below the straight line between CTG-Ref and CDG.
struct ThroughputTrends {
    int steps = 0;  // number of steps to the next larger share of left or right turns, at all greens and populations
    int rises = 0;  // number of steps in which throughput rises
    double largest_rise_percent = 0.0;
    std::string largest_rise;  // population, green and turns of the largest rise
    int points = 0;            // number of combinations of mixed population, green and turns
    int above_line = 0;        // number of these combinations above the straight line
};
ThroughputTrends throughput_trends(const CsvTable& results);

}  // namespace stopline
