// Results of a sweep: the text of each run in the store, the table of all runs, and the provenance of the table.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "runs/run_metrics.h"
#include "sweeps/run_store.h"
#include "sweeps/sweep.h"

namespace stopline {

// Returns the result of a run as text with one line "column=value" for each axis, for the seed and for each metric. The
// text can be read without the sweep file, so any machine can merge the stores of several machines.
std::string result_text(const Sweep& sweep, std::size_t point, const std::vector<RunMetric>& metrics);

// Returns the value of a column in a result text; "" if the text does not have the column.
std::string value_in(const std::string& result, const std::string& column);

// Returns the whole number in a column of a result text; 0 if the column is missing or holds no whole number.
std::int64_t count_in(const std::string& result, const std::string& column);

struct SweepTotals {
    std::size_t runs = 0;
    std::int64_t updates = 0;
    std::int64_t overlaps = 0;
    std::int64_t red_entries = 0;
    std::int64_t lost_vehicles = 0;
    std::size_t runs_with_violations = 0;
    std::optional<std::int64_t> deadlocks;  // set for single intersections only
    std::optional<std::int64_t> gridlocks;  // set for networks of several intersections only
    std::int64_t teleported = 0;            // number of teleported vehicles in networks of several intersections
    std::size_t starving_runs = 0;          // number of runs in which a movement starves
    double longest_in_junction_s = 0.0;     // longest stay of a vehicle in an intersection, over all runs
    std::size_t measured_in_warm_up = 0;    // number of runs whose measured window begins before the warm-up ends
    std::size_t with_backlog = 0;           // number of runs with a backlog of vehicles at the end
};

struct SweepTable {
    std::string csv;  // one row for each run, in the order of the points
    SweepTotals totals;
    // One warning for each column of the store that still has its name of the previous release.
    std::vector<std::string> warnings;
};
// Returns the result table of a store. If the store has column names of the previous release, the table has the current
// names instead.
SweepTable sweep_results(const RunStore& store);

// Returns the provenance as JSON text. `command` is a command line that reproduces the results of the whole sweep.
std::string sweep_provenance(const Sweep& sweep, const std::string& command);

}  // namespace stopline
