// All populations of an intersection, side by side in threads, and what is reported of them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "experiment/intersection_run.h"
#include "experiment/run.h"

namespace stopline {

struct IntersectionReport {
    Scenario scenario;
    std::vector<IntersectionFigures> populations;  // in the order of the scenario
    std::vector<std::vector<TrajectoryPoint>>
        trajectories;  // [population] of the first measured cycle; empty: not asked for

    // Of throughput over the baseline, in percent; NaN without one.
    double improvement_percent(const IntersectionFigures& figures) const;
    bool no_violations() const;
};

struct IntersectionOptions {
    int threads = 1;
    double trajectory_interval_s = 0.0;       // a whole number of steps; 0: no trajectories
    std::function<bool(double)> on_progress;  // gets the share done; returns false to stop: throws Interrupted
    Observation observation = {};
};

// The same bits for any number of threads.
IntersectionReport run_intersections(const Scenario& scenario, const IntersectionOptions& options);

std::string intersection_csv(const IntersectionReport& report);  // a row a population
std::string intersection_trajectories_csv(const IntersectionReport& report);
std::string headways_csv(const IntersectionReport& report);  // by position in the queue

}  // namespace stopline
