// Names of vehicles in result files.
#pragma once

#include <string>

#include "sim/state/model.h"

namespace stopline {

// Returns the name of the vehicle's trip, escaped for XML, or the number of the vehicle if it has no trip with a name.
std::string vehicle_name(const Model& model, int trip, int vehicle);

}  // namespace stopline
