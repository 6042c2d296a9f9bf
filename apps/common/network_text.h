// Result tables of a network (grid, streets or imported from SUMO) for the terminal.
#pragma once

#include <string>

#include "runs/network/network.h"

namespace stopline {

std::string network_text(const NetworkReport& report);

}  // namespace stopline
