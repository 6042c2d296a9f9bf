// Results of networks of streets: inflow by side, congestion by approach, turn shares and lane changes (Section VII of
// the paper, Fig. 25 and 26).
#pragma once

#include <string>
#include <vector>

#include "runs/network/network.h"
#include "runs/run_metrics.h"

namespace stopline {

// These functions return the result tables as CSV text. scenarios/COLUMNS.md explains the columns.
std::string inflow_csv(const NetworkReport& report);
std::string approaches_csv(const NetworkReport& report);
std::string turns_csv(const NetworkReport& report);

// Returns the metrics that only streets have. Names with _early are means over minutes 15 to 60 of the run, and names
// with _late are means over minutes 65 to 120. In the paper, the queue on the corridor reaches the entries of the
// network between these two periods.
std::vector<RunMetric> street_metrics(const Scenario& scenario, const NetworkResult& result);

}  // namespace stopline
