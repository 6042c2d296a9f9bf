// Results of a sweep: the text of each run in the store, the table of all runs, and their provenance.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "runs/run_metrics.h"
#include "sweeps/run_store.h"
#include "sweeps/sweep.h"

namespace stopline {

// Returns the result of a run as text with one line "name=value" for each column: axes, seed and metrics. The text can
// be read without the sweep file, so stores of several machines can be joined anywhere.
std::string result_text(const Sweep& sweep, std::size_t point, const std::vector<RunMetric>& metrics);

// Returns the names of the columns in a result text, in their order.
std::vector<std::string> columns_in(const std::string& result);

// Returns the value of a column in a result text; empty if there is none.
std::string value_in(const std::string& result, const std::string& column);

// Returns the whole number in a column of a result text; 0 if there is none.
std::int64_t count_in(const std::string& result, const std::string& column);

struct SweepTotals {
    std::size_t runs = 0;
    std::int64_t updates = 0;
    std::int64_t overlaps = 0;
    std::int64_t red_entries = 0;
    std::int64_t lost_vehicles = 0;
    std::size_t runs_with_violations = 0;
    std::optional<std::int64_t> deadlocks;  // single intersections
    std::optional<std::int64_t> gridlocks;  // networks of several intersections
    std::int64_t teleported = 0;            // networks of several intersections
    double longest_in_junction_s = 0.0;     // maximum of all runs
    std::size_t measured_in_warm_up = 0;    // runs whose measured window begins before the warm-up ends
    std::size_t with_backlog = 0;           // runs in which vehicles found no room to enter before the end
};

struct SweepTable {
    std::string csv;  // one row for each run, in the order of the points
    SweepTotals totals;
    std::vector<std::string> warnings;  // one line for each old column name in the store
};
// Returns the results in a store. A store of the last release is read with its old column names.
SweepTable sweep_results(const RunStore& store);

// Returns the provenance as JSON text. `command` makes the results again, independent of shards and machines.
std::string sweep_provenance(const Sweep& sweep, const std::string& command);

}  // namespace stopline
