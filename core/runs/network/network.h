// Runs all populations of a scenario with several intersections, and writes the result tables.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "runs/network/network_run.h"
#include "runs/starvation.h"

namespace stopline {

struct NetworkReport {
    Scenario scenario;
    std::vector<NetworkResult> populations;  // in the order of scenario.populations
    std::vector<std::string> lanes;          // [lane] name of the lane

    // Returns by how many percent the throughput exceeds that of the baseline, the population that measure.baseline
    // names. Returns NaN without a baseline.
    double improvement_percent(const NetworkResult& result) const;
    // Returns the reduction of travel time against the baseline, %. Returns NaN without a baseline. Also returns NaN if
    // is_travel_time_biased() is true for the result or for the baseline.
    double time_saved_percent(const NetworkResult& result) const;
    bool no_violations() const;
    bool no_starvation() const;
    std::vector<PopulationStarvations> starvations() const;
};

// Returns true if the travel time by Little's law (vehicles in the area divided by throughput) is more than 1.5 times
// the measured travel time. The measured travel time is then too short, because it covers only vehicles that leave the
// area.
bool is_travel_time_biased(const NetworkResult& result);

struct NetworkOptions {
    int threads = 1;
    std::function<bool(double)> on_progress;  // gets the completed share, 0 .. 1; returns false to stop
    Observation observation = {};
};

// Runs all populations at the same time in threads. The results are the same to the bit for any number of threads.
// Throws Interrupted if on_progress returns false.
NetworkReport run_networks(const Scenario& scenario, const NetworkOptions& options);

// Returns a text for the user with the start and the end of the measured window. If this window is shorter than
// measure.window or does not end with the run, the text gives the reason.
std::string window_text(const NetworkReport& report);

// These functions return the result tables as CSV text. scenarios/COLUMNS.md explains the columns.
std::string network_csv(const NetworkReport& report);         // summary.csv
std::string network_series_csv(const NetworkReport& report);  // series.csv
std::string origin_destination_csv(const NetworkReport& report);
std::string delays_csv(const NetworkReport& report);
std::string lane_delays_csv(const NetworkReport& report);
std::string gridlocks_csv(const NetworkReport& report);
std::string rules_csv(const NetworkReport& report);
std::string street_time_space_csv(const NetworkReport& report);  // time_space.csv

}  // namespace stopline
