// What runs over streets that a user describes tell beyond network.h: inflow by side, backlogs, turns, changes of lanes (Section VII,
// Fig. 25 and 26).
#pragma once

#include <string>
#include <vector>

#include "experiment/gnuplot.h"
#include "experiment/network.h"
#include "experiment/run_metrics.h"

namespace stopline {

std::string inflow_csv(const NetworkReport& report);      // a row a population and interval
std::string approaches_csv(const NetworkReport& report);  // a row a population, approach and interval
std::string turns_csv(
    const NetworkReport& report);  // a row a population and approach: shares that were asked for, and realised

// Inflow from west, from east and from the streets that cross, over time.
Figure inflow_figure(const NetworkReport& report);
// Mean speeds over place and time, eastwards and westwards: where queues are that do not clear.
Figure backlog_figure(const NetworkReport& report);

// Means before and after the time at which the paper's backlog reaches the inflow (minutes 15 to 60 and 65 to 120), when each approach
// was filled, inflow, turns, changes.
std::vector<RunMetric> street_metrics(const Scenario& scenario, const NetworkFigures& figures);

}  // namespace stopline
