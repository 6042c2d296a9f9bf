// The results of one run as a list of named values. Sweeps store these lists. The values do not depend on the machine,
// the number of threads or the time of day.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scenario/scenario.h"

namespace stopline {

// One named value. The value is stored as text, so that whole numbers, hashes and rounded numbers reach the result
// table unchanged.
struct RunMetric {
    std::string column;  // name of the column in the result table; ends with the unit
    std::string value;   // empty: the run has no such value
};

// Runs scenario.populations[population] and returns the metrics of the run. `keep_going` is called repeatedly during
// the run. If it returns false, the run is stopped and the result is empty. For every kind of network, the result has
// the metrics overlaps, red_entries, lost_vehicles and updates.
std::vector<RunMetric> run_metrics(const Scenario& scenario, std::size_t population,
                                   const std::function<bool()>& keep_going = {});

// Returns the names of the result columns of the scenario, without running it.
std::vector<std::string> result_columns(const Scenario& scenario);

}  // namespace stopline
