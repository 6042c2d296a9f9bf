// Results of networks of streets: inflow by side, congestion by approach, turn shares and lane changes (Section VII of
// the paper, Fig. 25 and 26).
#pragma once

#include <string>
#include <vector>

#include "runs/network/network.h"
#include "runs/run_metrics.h"

namespace stopline {

// The result tables as CSV text; scenarios/COLUMNS.md explains the columns.
std::string inflow_csv(const NetworkReport& report);
std::string approaches_csv(const NetworkReport& report);
std::string turns_csv(const NetworkReport& report);

// Returns the metrics that only streets have. Some are means over minutes 15 to 60 (early) and over minutes 65 to 120
// (late). In the paper the queue of the corridor reaches its inlets between these two periods.
std::vector<RunMetric> street_metrics(const Scenario& scenario, const NetworkResult& result);

}  // namespace stopline
