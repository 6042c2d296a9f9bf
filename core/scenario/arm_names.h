// Names of the approaches of a network, where demand can enter (demand.approaches).
#pragma once

#include <string>
#include <vector>

#include "network/network_settings.h"

namespace stopline {

// Returns the name of each approach once, entries of the network first: "c0r0_west" for the lanes c0r0_west_in_0 and
// c0r0_west_in_1. An imported network gives the names of its edges. Throws InputError if the network cannot be built.
std::vector<std::string> approach_names(const NetworkSettings& network);

}  // namespace stopline
