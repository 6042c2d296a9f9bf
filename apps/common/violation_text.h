// The first violation of a run as text: when and where it occurred, and how to see it.
#pragma once

#include <string>
#include <vector>

#include "sim/state/events.h"
#include "sim/state/queries/vehicle_names.h"

namespace stopline {

// `lanes`: the names of all lanes. Returns an empty text if no first violation is recorded.
std::string first_violation_text(const std::string& population, const Violations& violations,
                                 const VehicleNames& vehicle_names, const std::vector<std::string>& lanes);

}  // namespace stopline
