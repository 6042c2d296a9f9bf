// Means over the seeds of a sweep with 95 % confidence intervals, and the difference of each population from the first
// one. Differences are taken between runs with the same seed.
#pragma once

#include <string>

#include "base/io/csv.h"

namespace stopline {

// Returns true if the result table has two or more runs with the same axis values.
bool has_seeds(const CsvTable& results);

// Returns a table with one row for each combination of axis values and each numeric metric. The row holds the mean over
// the seeds and its two-sided Student interval. It also holds the mean difference from the first population and its
// interval; if that interval excludes 0, the difference is significant at 5 %. `population` is the column of the
// populations. Fields are empty if fewer than two runs have the value, and differences are empty for the first
// population.
std::string seed_means_csv(const CsvTable& results, const std::string& population);

}  // namespace stopline
