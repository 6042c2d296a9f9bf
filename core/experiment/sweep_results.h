// What a sweep leaves behind: the text that a store keeps of a run, the table of all runs, and where they come from.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "experiment/run_metrics.h"
#include "experiment/run_store.h"
#include "experiment/sweep.h"

namespace stopline {

// One line a column, "name=value": the axes, the seed, the metrics. It needs no sweep file to be read, so that stores of
// several machines can be joined anywhere.
std::string result_text(const Sweep& sweep, std::size_t point, const std::vector<RunMetric>& metrics);

// The names of its columns, in their order.
std::vector<std::string> columns_in(const std::string& result);

// The text in a column of it; "" where there is none.
std::string value_in(const std::string& result, const std::string& column);

// The whole number in a column of such a text; 0 where there is none.
std::int64_t count_in(const std::string& result, const std::string& column);

struct SweepTotals {
    std::size_t runs = 0;
    std::int64_t updates = 0;
    std::int64_t overlaps = 0;
    std::int64_t red_entries = 0;
    std::int64_t lost_vehicles = 0;
    std::size_t runs_with_violations = 0;
    std::optional<std::int64_t> deadlocks;  // of single intersections, where they are looked for
    std::optional<std::int64_t> gridlocks;  // of several, where vehicles may wait inside for as long as others do
    std::int64_t moved_on = 0;              // the same
    double longest_inside_s = 0.0;          // see IntersectionFigures
    std::size_t unsettled = 0;              // runs of several intersections that were measured before traffic settled
    std::size_t with_waiting = 0;           // runs in which vehicles found no room to enter until the end
};

struct SweepTable {
    std::string csv;  // a row a run, in the order of the points
    SweepTotals totals;
};
SweepTable sweep_results(const RunStore& store);

// JSON text; `command` makes the results again, whatever the shards and machines it was spread over.
std::string sweep_provenance(const Sweep& sweep, const std::string& command);

}  // namespace stopline
