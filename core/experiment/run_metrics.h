// One run of a scenario as a flat list of named values: what a sweep stores of it. Nothing in it depends on the machine, the
// number of threads or the time of day.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "scenario/scenario.h"

namespace stopline {

// A value is a text, so that counts, hashes and rounded numbers go to the table of results as they are.
struct RunMetric {
    std::string name;
    std::string unit;   // as the end of a column's name: "s", "m", "veh", "percent"; "" for plain numbers
    std::string value;  // "": there is none, such as a headway where nobody has settled

    std::string column() const { return unit.empty() ? name : name + "_" + unit; }
};

RunMetric number_metric(std::string name, std::string unit, double value, int decimals);
RunMetric count_metric(std::string name, std::string unit, std::int64_t value);

// Runs one population of the scenario. `keep_going` is called now and then; once it returns false the run ends, and the
// result is empty. Metrics named overlaps, red_entries, lost_vehicles and updates are there for every kind of network.
std::vector<RunMetric> run_metrics(const Scenario& scenario, std::size_t population,
                                   const std::function<bool()>& keep_going = {});

// The columns of the metrics that a run of the scenario would give. Nothing is run.
std::vector<std::string> result_columns(const Scenario& scenario);

}  // namespace stopline
