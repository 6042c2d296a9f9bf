// The report by the Highway Capacity Manual for the console.
#pragma once

#include <string>
#include <vector>

#include "runs/hcm/hcm_tables.h"

namespace stopline {

// Returns the tables of all populations. Only approaches and intersections are listed if there are many lanes.
std::string hcm_text(const std::vector<PopulationHcm>& populations);

}  // namespace stopline
