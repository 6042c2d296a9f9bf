// What several seeds of a sweep say together: means with 95 % intervals, and what each population gains over the first one, tested with
// the differences of runs that have the same seed.
#pragma once

#include <string>

#include "experiment/csv.h"

namespace stopline {

// Whether a table of results has two runs or more of the same axes.
bool has_seeds(const CsvTable& results);

// A row for each combination of axes and each metric that is a number: runs, mean, low, high (two-sided Student's interval); and, but for
// the one of the column `population` that comes first among its combinations, the mean difference to that one's run of the same seed with its
// interval (difference, difference_low, difference_high). Where that does not contain 0 the difference is significant at 5 %. Empty
// fields: fewer than two runs have the value.
std::string seed_means_csv(const CsvTable& results, const std::string& population);

}  // namespace stopline
