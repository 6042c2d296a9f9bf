// Runs the sweeps that the scorecard needs. Finished runs are stored in the scorecard's folder, so a restarted program
// continues an interrupted sweep.
#pragma once

#include <string>
#include <vector>

#include "paper/scorecard.h"
#include "sweeps/run_store.h"
#include "sweeps/sweep.h"
#include "sweeps/sweep_results.h"
#include "sweeps/sweep_run.h"

namespace stopline {

// The part of an experiment's work that one sweep does, for progress reports. The whole experiment is the range 0 to 1.
struct ProgressRange {
    double from;
    double to;
};

struct SweepRuns {
    Sweep sweep;
    RunStore store;
    SweepTotals totals;
};

// Simulates those runs of a sweep that are not stored yet, and returns the complete sweep. `file` is the name of the
// sweep file in scenarios/sweeps. `name` is the name of the store file, without .sqlite. Throws InputError if a run
// fails. Throws Interrupted if on_progress returns false; finished runs remain stored.
SweepRuns run_sweep(const ScorecardOptions& options, const char* file, const std::vector<std::string>& overrides,
                    const char* name, RunFunction function, ProgressRange range);

}  // namespace stopline
