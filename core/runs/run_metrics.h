// The results of one run as a flat list of named values, as sweeps store them. They do not depend on the machine, the
// number of threads or the time of day.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "scenario/scenario.h"

namespace stopline {

// A value is a text, so that counts, hashes and rounded numbers are written to the result table unchanged.
struct RunMetric {
    std::string name;
    std::string unit;   // end of the column name: "s", "m", "veh_h", "percent"; empty for counts and texts
    std::string value;  // empty: no value

    // Returns the name of the column in the result table.
    std::string column() const { return unit.empty() ? name : name + "_" + unit; }
};

RunMetric number_metric(std::string name, std::string unit, double value, int decimals);
RunMetric count_metric(std::string name, std::string unit, std::int64_t value);

// Runs one population of the scenario. The run ends early, with an empty result, once `keep_going` returns false. All
// kinds of networks have the metrics overlaps, red_entries, lost_vehicles and updates.
std::vector<RunMetric> run_metrics(const Scenario& scenario, std::size_t population,
                                   const std::function<bool()>& keep_going = {});

// Returns the columns that a run of the scenario would give, without running it.
std::vector<std::string> result_columns(const Scenario& scenario);

}  // namespace stopline
