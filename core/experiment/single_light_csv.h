// The results of a single light as CSV texts. Times count from the start of green; columns are listed in each writer.
#pragma once

#include <string>

#include "experiment/single_light.h"

namespace stopline {

std::string passages_csv(const SingleLight& result);     // every front at a stop line within the green
std::string summary_csv(const SingleLight& result);      // one row a population
std::string improvement_csv(const SingleLight& result);  // one row a population and green time
// One row a vehicle and sample; the front's place counts from the stop line, negative before it.
std::string trajectories_csv(const SingleLight& result, double interval_s);

}  // namespace stopline
