// Texts of stopline-sweep: the list of runs and the totals of a sweep.
#pragma once

#include <string>

#include "sweeps/sweep.h"
#include "sweeps/sweep_results.h"

namespace stopline {

// Returns the list of all runs of a shard as CSV.
std::string points_csv(const Sweep& sweep, const Shard& shard);

// Returns a table of the totals over all runs, with notes about runs that need attention.
std::string totals_text(const SweepTotals& totals);

}  // namespace stopline
