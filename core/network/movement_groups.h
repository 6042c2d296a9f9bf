// Signal groups for the movements of generated intersections. A movement is a side of the intersection together with a
// turn, such as west_left: the left turns of the vehicles that come from the west.
#pragma once

#include <string>
#include <vector>

#include "network/lane_graph.h"

namespace stopline {

// Returns the name of the movement of a connection, such as west_left.
std::string movement_name(const LaneGraph& graph, int connection);

// Returns the names of the movements of an intersection with these approach lanes, in the order of their signal groups.
// The sides come in the order west, south, east, north, and the turns of each side in the order straight, right, left.
std::vector<std::string> movement_names(const IntersectionSettings& intersection);

// Sets the signal groups of all movements. `graph` comes from make_intersection() or make_grid(). `movements`: the
// result of movement_names(). `groups`: the group of each of them within its intersection, counted from 0. With n
// groups, intersection k gets the groups n k .. n k + n - 1. The stop line of a lane gets the group of the first
// connection of this lane. If the groups of a lane differ, each of its connections also stores its own group in
// Lane::movement_signal_group.
void assign_movement_groups(LaneGraph& graph, const std::vector<std::string>& movements,
                            const std::vector<int>& groups);

}  // namespace stopline
