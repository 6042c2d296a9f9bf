// Starving movements as text for the console.
#pragma once

#include <string>
#include <vector>

#include "runs/starvation.h"
#include "scenario/scenario.h"

namespace stopline {

// Returns the verdict: the first starving movements of each population, or that there are none. `lanes`: [lane] name of
// the lane. Returns "" if measure.starvation is 0.
std::string starvation_text(const Scenario& scenario, const std::vector<PopulationStarvations>& populations,
                            const std::vector<std::string>& lanes);

}  // namespace stopline
