// All populations of a scenario with one intersection, and their result tables.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "runs/intersection/intersection_run.h"
#include "runs/run.h"

namespace stopline {

struct IntersectionReport {
    Scenario scenario;
    std::vector<IntersectionResult> populations;             // in the order of the scenario
    std::vector<std::vector<TrajectoryPoint>> trajectories;  // [population] first measured cycle; empty: not requested

    // Returns the gain in throughput over the baseline, %; NaN without a baseline.
    double improvement_percent(const IntersectionResult& result) const;
    bool no_violations() const;
};

struct IntersectionOptions {
    int threads = 1;
    double trajectory_interval_s = 0.0;       // whole number of steps; 0: no trajectories
    std::function<bool(double)> on_progress;  // takes the share done, 0 .. 1; return false to stop
    Observation observation = {};
};

// Runs all populations side by side in threads. The results are the same to the bit for any number of threads. Throws
// Interrupted if on_progress returns false.
IntersectionReport run_intersections(const Scenario& scenario, const IntersectionOptions& options);

// The result tables as CSV text; scenarios/COLUMNS.md explains the columns.
std::string intersection_csv(const IntersectionReport& report);               // summary.csv
std::string intersection_trajectories_csv(const IntersectionReport& report);  // trajectories.csv
std::string headways_csv(const IntersectionReport& report);

}  // namespace stopline
