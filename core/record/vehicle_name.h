// Names of vehicles in result files.
#pragma once

#include <string>

#include "sim/state/model.h"

namespace stopline {

// Returns the name of the vehicle's trip, or the number of the vehicle if its trip has no name. The name is escaped
// for XML.
std::string vehicle_name(const Model& model, int trip, int vehicle);

}  // namespace stopline
