// Builds the lane graph of a scenario's network, for all values of network.kind.
#pragma once

#include "network/lane_graph.h"
#include "network/network_settings.h"

namespace stopline {

// Builds the lane graph of the network. Files that it names must have been read before (NetworkKind::import_files).
LaneGraph make_network(const NetworkSettings& network);

// Returns the distance from the stop line at the end of `lane` to the centre of the intersection, m. Returns 0 for
// imported networks, whose intersections have no radius.
double radius_beyond_m(const NetworkSettings& network, const Lane& lane);

}  // namespace stopline
