// Runs all populations of a scenario with a single intersection, and writes the result tables.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "runs/intersection/intersection_run.h"
#include "runs/run.h"
#include "runs/starvation.h"

namespace stopline {

struct IntersectionReport {
    Scenario scenario;
    std::vector<IntersectionResult> populations;             // in the order of scenario.populations
    std::vector<std::vector<TrajectoryPoint>> trajectories;  // [population] first measured cycle only; empty: none
    std::vector<std::string> lanes;                          // [lane] name of the lane

    // Returns by how many percent the throughput exceeds that of the baseline, the population that measure.baseline
    // names. Returns NaN without a baseline.
    double improvement_percent(const IntersectionResult& result) const;
    bool no_violations() const;
    bool no_starvation() const;
    std::vector<PopulationStarvations> starvations() const;
};

struct IntersectionOptions {
    int threads = 1;
    double trajectory_interval_s = 0.0;       // sampling interval, a whole number of steps; 0: no trajectories
    std::function<bool(double)> on_progress;  // gets the completed share, 0 .. 1; returns false to stop
    Observation observation = {};
};

// Runs all populations at the same time in threads. The results are the same to the bit for any number of threads.
// Throws Interrupted if on_progress returns false.
IntersectionReport run_intersections(const Scenario& scenario, const IntersectionOptions& options);

// These functions return the result tables as CSV text. scenarios/COLUMNS.md explains the columns.
std::string intersection_csv(const IntersectionReport& report);               // summary.csv
std::string intersection_trajectories_csv(const IntersectionReport& report);  // trajectories.csv
std::string headways_csv(const IntersectionReport& report);

}  // namespace stopline
