// All populations of a scenario with several intersections, and their result tables.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "runs/network/network_run.h"

namespace stopline {

struct NetworkReport {
    Scenario scenario;
    std::vector<NetworkResult> populations;  // in the order of the scenario
    std::vector<std::string> lanes;          // [lane] name

    // Returns the gain in throughput over the baseline, %; NaN without a baseline.
    double improvement_percent(const NetworkResult& result) const;
    // Returns the reduction of travel time below the baseline, %. Returns NaN without a baseline, and if the travel
    // time of either is biased.
    double time_saved_percent(const NetworkResult& result) const;
    bool no_violations() const;
};

// Returns true if travel times understate the delay, because they cover only vehicles that leave the area. This is the
// case if vehicles in the area over exits (Little's law) is more than 1.5 times the mean travel time.
bool is_travel_time_biased(const NetworkResult& result);

struct NetworkOptions {
    int threads = 1;
    std::function<bool(double)> on_progress;  // takes the share done, 0 .. 1; return false to stop
    Observation observation = {};
};

// Runs all populations side by side in threads. The results are the same to the bit for any number of threads. Throws
// Interrupted if on_progress returns false.
NetworkReport run_networks(const Scenario& scenario, const NetworkOptions& options);

// Returns a text with the measured window. It gives the reason if the window differs from measure.window.
std::string window_text(const NetworkReport& report);

// The result tables as CSV text; scenarios/COLUMNS.md explains the columns.
std::string network_csv(const NetworkReport& report);         // summary.csv
std::string network_series_csv(const NetworkReport& report);  // series.csv
std::string origin_destination_csv(const NetworkReport& report);
std::string delays_csv(const NetworkReport& report);
std::string gridlocks_csv(const NetworkReport& report);
std::string rules_csv(const NetworkReport& report);
std::string street_time_space_csv(const NetworkReport& report);  // time_space.csv

}  // namespace stopline
