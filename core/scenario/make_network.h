// Builds the lane graph of a scenario's network, for all values of network.kind.
#pragma once

#include "network/lane_graph.h"
#include "network/network_settings.h"
#include "scenario/scenario.h"

namespace stopline {

// Builds the lane graph of the network. Files that it names must have been read before (NetworkKind::import_files).
LaneGraph make_network(const NetworkSettings& network);

// Sets the signal groups of an intersection or a grid as the phases of the scenario need them. Movements with the same
// lights share a group. Without phases, the groups stay as they are.
void assign_phase_groups(const Scenario& scenario, LaneGraph& graph);

// Returns the position of the stop line of a lane, or of its end if it has no stop line, m from its start.
double end_of_lane_m(const Lane& lane);
// Returns the position of an induction loop, m from the start of its lane.
double loop_position_m(const LoopSettings& loop, const Lane& lane);

// Returns the distance from the stop line at the end of `lane` to the centre of the intersection, m. Returns 0 for
// imported networks, whose intersections have no radius.
double radius_beyond_m(const NetworkSettings& network, const Lane& lane);

}  // namespace stopline
