// What a sweep over the green time and the turns of an intersection shows: throughput, travel time and density over the turn
// ratios (Fig. 9 of the paper, for every green) and the improvement beside Table 1. Read from the table of results alone.
#pragma once

#include <string>
#include <vector>

#include "experiment/csv.h"
#include "experiment/gnuplot.h"
#include "experiment/targets.h"

namespace stopline {

// Whether the table has the axes green, left, right and population, and an intersection's metrics.
bool has_turns(const CsvTable& results);

// One figure a green time, named turns_green_15. Means over seeds.
std::vector<Figure> turn_figures(const CsvTable& results);

// Rows T01.. of the paper's numbers: paper, ours, difference, in percentage points. Empty fields where the table lacks a point.
std::string table1_csv(const CsvTable& results, const std::vector<Target>& targets);

// What Section IV says of orders, on the mean throughputs: that it falls with turns, and grows with the share of CDG more
// than in proportion (below the straight line between none and all). How many steps and points do not, and by how much.
struct Orders {
    int steps = 0;  // to the next larger ratio of left or of right turns, all greens and populations
    int rises = 0;
    double largest_rise_percent = 0.0;
    std::string largest_rise;  // where
    int points = 0;            // populations P1 .. P99, all greens and turns
    int above = 0;
};
Orders orders_of(const CsvTable& results);

}  // namespace stopline
