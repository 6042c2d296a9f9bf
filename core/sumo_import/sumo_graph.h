// Turns a SUMO network into a LaneGraph.
//
// - Every lane open to cars becomes a lane with SUMO's name and length. The lanes of an edge form an approach.
// - Every connection becomes one lane inside an intersection. If SUMO splits the connection into several internal
//   lanes, the import joins them.
// - The stretch that the connections of a lane share becomes part of the lane, as in generated networks.
// - U-turns are extended into the junction until the other movements have diverged. netconvert draws a U-turn directly
//   at the end of its lane.
// - Conflict areas follow from the shapes. They exist between links that are foes in SUMO's matrix, between links to
//   the same lane, and between a U-turn and any other link.
// - Right of way follows SUMO's matrix `response`. Two links of one signal yield only if they are green together. Then
//   a link with the letter 'g' also yields to a link with 'G'.
// - Every lane of an approach with connections has a stop line. Signal group 0, which is always green, serves the stop
//   lines without a signal.
// - Connections to a lane on which a vehicle could not brake to a stop get a lower speed limit v. It follows from the
//   deceleration b: v^2 = 2 b (length - margin).
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "network/lane_graph.h"
#include "sumo_import/sumo_net.h"

namespace stopline {

// The source of the lights of a signal group: the letter of one link in the phases of a SUMO signal.
struct SumoLight {
    int signal = -1;  // index in SumoNet::signals; -1: always green
    int link = 0;     // index of the letter in SumoPhase::state
};

struct SumoNetwork {
    SumoNet net;
    LaneGraph graph;
    std::vector<SumoLight> lights;          // [signal group]
    std::vector<std::vector<int>> lane_of;  // [edge][index] lane of the graph; -1: closed to cars, or inside a junction
    std::vector<int> approach_of;           // [edge] approach of the graph; -1: closed to cars, or inside a junction

    // Returns the longest signal cycle, or 90 s if there are no signals.
    double longest_cycle_s() const;
    // Returns the longest green time that ends, or 40 s if there is none.
    double longest_green_s() const;
};

// Builds the lane graph. Connections whose centre lines come closer than `clearance_m` conflict. Throws InputError with
// file and line if the network cannot be converted.
SumoNetwork make_sumo_network(SumoNet net, double clearance_m);

// Returns true for the signal letters at which vehicles may go: G, g, s, o, O.
bool sumo_is_green(char letter);

}  // namespace stopline
