// Means over the seeds of a sweep, for rows that compare populations or settings.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>

#include "paper/measurements.h"
#include "paper/scorecard.h"

namespace stopline {

// Returns the name of a group of runs, such as "with 15 CDG".
using NameOfRuns = std::function<std::string(const Scenario& scenario, const std::string& population)>;

// Runs the sweep scenarios/sweeps/<sweep>.yaml. Stores the mean over all runs of one name for each of the result
// columns. The name of a measurement is the name of the column, a space and the name of the runs. The measurement
// "violations" is the number of runs with violations.
Measurements measure_means(const ScorecardOptions& options, const char* sweep, std::span<const char* const> columns,
                           const NameOfRuns& name_of);

// Returns the mean of a column over the runs of one name, or nothing if it has not been measured.
std::optional<double> mean_of_column(const Measurements& measured, const std::string& column, const std::string& runs);

// Returns value / reference in percent, minus `subtracted`. Returns nothing if one of the values is missing.
std::optional<Answer> percent_answer(std::optional<double> value, std::optional<double> reference, double subtracted);

}  // namespace stopline
