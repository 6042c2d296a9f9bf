// Turns a SUMO network into a LaneGraph.
//
// - Every lane open to passenger cars becomes a lane with SUMO's name and length. The lanes of an edge are an approach.
// - Every connection becomes one lane inside an intersection: the joined lanes of the connection's `via` chain.
// - The stretch that the connections of a lane share belongs to that lane, as in generated networks.
// - U-turns are extended to where the other movements diverge, because netconvert draws them on the spot.
// - Conflict areas follow from the shapes. They exist between foes, between links to the same lane, and between a
//   U-turn and any other link.
// - Right of way follows the `response` matrix. With signals, only links that are green together yield, and a link with
//   'G' does not yield to one with 'g'.
// - Every lane with a connection has a stop line. Without a signal its light is always green (signal group 0).
// - Connections to a lane that is too short to stop on get a lower speed limit: v^2 = 2 b (length - margin).
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "network/lane_graph.h"
#include "sumo_import/sumo_net.h"

namespace stopline {

// The source of a signal group's lights: one letter in the phases of a signal.
struct SumoLight {
    int signal = -1;  // index in SumoNet::signals; -1: always green
    int link = 0;     // index of the letter
};

struct SumoNetwork {
    SumoNet net;
    LaneGraph graph;
    std::vector<SumoLight> lights;          // [signal group]
    std::vector<std::vector<int>> lane_of;  // [edge][index] lane of the graph; -1: closed to cars
    std::vector<int> approach_of;           // [edge] approach of the graph; -1: closed to cars

    // Returns the longest signal cycle, or 90 s if there are no signals.
    double longest_cycle_s() const;
    // Returns the longest green time, or 40 s if no green ends.
    double longest_green_s() const;
};

// Builds the lane graph. Centre lines closer than `clearance_m` conflict. Throws InputError with file and line.
SumoNetwork make_sumo_network(SumoNet net, double clearance_m);

// Returns true for the letters at which vehicles may go: G, g, s, o, O.
bool sumo_is_green(char letter);

}  // namespace stopline
