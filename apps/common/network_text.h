#pragma once

#include <string>

#include "experiment/network.h"

namespace stopline {

// The table that a user reads after a run of several intersections.
std::string network_text(const NetworkReport& report);

}  // namespace stopline
