// Result tables of a single light for the terminal.
#pragma once

#include <string>

#include "runs/single_light/single_light.h"

namespace stopline {

std::string counts_text(const SingleLightReport& result);    // vehicles passed and improvement, per green time
std::string ideal_text(const SingleLightReport& result);     // the same for ideal platoons, and mean improvements
std::string headways_text(const SingleLightReport& result);  // gaps and headways in steady state, and at the stop line
std::string queue_text(const SingleLightReport& result);     // populations with an open queue; empty if there are none
std::string violations_text(const SingleLightReport& result);  // a table, or one line if there are none

}  // namespace stopline
