// Builds the lane graph of a scenario's network, whatever its kind.
#pragma once

#include "network/lane_graph.h"
#include "network/network_settings.h"

namespace stopline {

// Builds the lane graph of the chosen network kind. An imported network must have been read before.
LaneGraph make_network(const NetworkSettings& network);

// Returns the distance from the stop line at the end of `lane` to the centre of its intersection, in m.
// Imported networks give 0: their connections have lengths of their own.
double radius_beyond_m(const NetworkSettings& network, const Lane& lane);

}  // namespace stopline
