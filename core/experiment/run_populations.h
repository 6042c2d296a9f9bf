// All populations of a scenario, side by side in threads. Each run owns its model and state, so the results are the same to
// the last bit for any number of threads, and they come in the order of the scenario.
#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "experiment/interrupted.h"
#include "experiment/run.h"

namespace stopline {

struct RunAllOptions {
    int threads = 1;
    double trajectory_interval_s = 0.0;  // 0: keep none
    double trajectory_from_s = 0.0;
    double trajectory_until_s = std::numeric_limits<double>::infinity();
    // Share done of all runs (0..1), called now and then by one thread at a time; return false to stop.
    std::function<bool(double)> on_progress;
    Observation observation = {};
};

// Throws Interrupted where on_progress asked to stop, and what a run threw (the first in the order of the scenario).
std::vector<RunResult> run_populations(const Scenario& scenario, const RunAllOptions& options = {});

}  // namespace stopline
