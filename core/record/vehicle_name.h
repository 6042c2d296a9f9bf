// What a vehicle is called in tables: as its trip, where that has a name, else by its number.
#pragma once

#include <string>

#include "sim/model.h"

namespace stopline {

// Ready for the value of an attribute.
std::string vehicle_name(const Model& model, int trip, int vehicle);

}  // namespace stopline
