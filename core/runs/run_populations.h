// Runs all populations of a scenario at the same time in threads. Each run owns its model and state, so the results are
// the same to the bit for any number of threads.
#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "runs/interrupted.h"
#include "runs/run.h"

namespace stopline {

struct RunAllOptions {
    int threads = 1;
    double trajectory_interval_s = 0.0;  // sampling interval; 0: no trajectories
    double trajectory_from_s = 0.0;
    double trajectory_until_s = std::numeric_limits<double>::infinity();
    // Called with the completed share of all runs, 0 .. 1, by one thread at a time. Returns false to stop all runs.
    std::function<bool(double)> on_progress;
    Observation observation = {};
};

// Returns the results in the order of scenario.populations. If runs fail, throws the exception of the first failed
// population in this order. Throws Interrupted if on_progress returns false.
std::vector<RunResult> run_populations(const Scenario& scenario, const RunAllOptions& options = {});

}  // namespace stopline
