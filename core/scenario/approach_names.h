// Names of the approaches at which vehicles can enter a network (field demand.approaches).
#pragma once

#include <string>
#include <vector>

#include "network/network_settings.h"

namespace stopline {

// Returns the name of each approach once, such as "c0r0_west" for the lanes c0r0_west_in_0 and c0r0_west_in_1. The
// approaches at the border of the network come first. Throws InputError if the network cannot be built.
std::vector<std::string> approach_names(const NetworkSettings& network);

}  // namespace stopline
