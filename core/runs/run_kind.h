// The ways of running and measuring a scenario. Each kind of network names one of them (NetworkKind::run).
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "measure/zones.h"
#include "runs/run_metrics.h"
#include "scenario/scenario.h"

namespace stopline {

struct RunKind {
    std::string_view name;  // one of the names in scenario/kinds/network_kind.h
    // Runs one population and returns its metrics, as run_metrics() does.
    std::vector<RunMetric> (*metrics)(const Scenario& scenario, std::size_t population,
                                      const std::function<bool()>& keep_going);
    // Returns the period for which results are measured. It ends at the end of the run.
    TimeWindow (*measured_window)(const Scenario& scenario);
};

// Returns the way of running a scenario. Throws InputError if NetworkKind::run is an unknown name.
const RunKind& run_kind(const Scenario& scenario);

}  // namespace stopline
