// The result tables of a single light as CSV texts. scenarios/COLUMNS.md explains the columns.
#pragma once

#include <string>

#include "runs/single_light/single_light.h"

namespace stopline {

std::string passages_csv(const SingleLightReport& result);
std::string summary_csv(const SingleLightReport& result);
std::string improvement_csv(const SingleLightReport& result);
std::string trajectories_csv(const SingleLightReport& result, double interval_s);

}  // namespace stopline
