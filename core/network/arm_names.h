// What the arms are called on which lanes lead to intersections: where demand can enter.
#pragma once

#include <string>
#include <vector>

#include "network/network_settings.h"

namespace stopline {

// "c0r0_west" of the lanes c0r0_west_in_0 and c0r0_west_in_1: each arm once, those where the network begins first. Of an imported
// network names of edges. Throws InputError where the network cannot be made.
std::vector<std::string> arm_names(const NetworkSettings& network);

}  // namespace stopline
