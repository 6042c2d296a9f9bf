// Computes means over the seeds of a sweep with 95 % confidence intervals. For each population it also computes the
// mean difference from the baseline. The difference is taken between runs with the same seed.
#pragma once

#include <string>

#include "base/io/csv.h"

namespace stopline {

// Returns true if the result table has two or more runs with the same axis values.
bool has_seeds(const CsvTable& results);

// Returns a CSV table with one row for each combination of axis values and each numeric metric. The row holds the mean
// over the seeds and its two-sided Student interval. It also holds the mean difference from the population `baseline`,
// and the interval of this difference. If this interval excludes 0, the difference is significant at 5 %. If the table
// does not have the baseline, the first population of the table takes its place. `population` is the name of the column
// with the populations. Cells are empty if fewer than two runs have a value. The differences are also empty for the
// baseline.
std::string seed_means_csv(const CsvTable& results, const std::string& population, const std::string& baseline = "");

}  // namespace stopline
