// Result tables of runs with a single signal, for the terminal.
#pragma once

#include <string>

#include "runs/single_light/single_light.h"

namespace stopline {

// Returns a table of the vehicles that pass the stop line and the improvement over the baseline, for each green time.
std::string counts_text(const SingleLightReport& result);
// Returns a table of the vehicles that pass in ideal platoons for each green time, and of the mean improvements.
std::string ideal_text(const SingleLightReport& result);
// Returns a table of gaps and headways in steady state, and of headways and speeds at the stop line.
std::string headways_text(const SingleLightReport& result);
// Returns a list of populations whose queue has not closed up at the start of green; empty if there are none.
std::string queue_text(const SingleLightReport& result);
// Returns a table of the violations, or one line if there are none.
std::string violations_text(const SingleLightReport& result);

}  // namespace stopline
