// Sweeps that the scorecard needs. Their runs are stored in the scorecard's folder, so an interrupted sweep continues.
#pragma once

#include <string>
#include <vector>

#include "paper/scorecard.h"
#include "sweeps/run_store.h"
#include "sweeps/sweep.h"
#include "sweeps/sweep_results.h"
#include "sweeps/sweep_run.h"

namespace stopline {

// Part of an experiment's progress that one sweep covers, as shares of the experiment.
struct ProgressRange {
    double from;
    double to;
};

struct SweepRuns {
    Sweep sweep;
    RunStore store;
    SweepTotals totals;
};

// Runs the missing points of a sweep. `file` is in scenarios/sweeps, `name` is the name of the store. Throws
// Interrupted; the finished runs stay stored.
SweepRuns run_sweep(const ScorecardOptions& options, const char* file, const std::vector<std::string>& overrides,
                    const char* name, RunFunction function, ProgressRange range);

}  // namespace stopline
