// Sweeps behind rows of the scorecard. Their runs are kept in the scorecard's folder, so that one that was stopped goes on.
#pragma once

#include <string>
#include <vector>

#include "experiment/run_store.h"
#include "experiment/scorecard.h"
#include "experiment/sweep.h"
#include "experiment/sweep_results.h"
#include "experiment/sweep_run.h"

namespace stopline {

struct Part {
    double from;  // share of the experiment done before it, and behind it
    double to;
};

struct SweepRuns {
    Sweep sweep;
    RunStore store;
    SweepTotals totals;
};

// `file` in scenarios/sweeps, `name` of the store. Throws Interrupted; what is done by then is kept.
SweepRuns run_sweep(const ScorecardOptions& options, const char* file, const std::vector<std::string>& overrides,
                    const char* name, RunFunction function, Part part);

}  // namespace stopline
