// A SUMO network as a LaneGraph.
//
// - Every lane on which passenger cars may drive is a lane with SUMO's name and length; the lanes of an edge are an approach.
// - Every connection is one lane inside an intersection: the lanes of its chain of `via`, joined. As in the generators' networks, the
//   stretch that a lane's movements share belongs to the lane before. Who turns round does so where the others part, not on the spot.
// - Conflict areas follow from the shapes, for the links that the junctions' matrices call foes, and where two ways end on the same lane.
// - Who gives way: the `response` matrix. Of links with lights only those that are green together give way, and one with 'G' not to one
//   with 'g'.
// - Every lane that leads on has a stop line. Where there is no signal, its light is always green (signal group 0).
// - Lanes that are too short to stop on before their stop line are entered more slowly: v^2 = 2 b (length - margin).
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "network/lane_graph.h"
#include "network/sumo_net.h"

namespace stopline {

// The light of a signal group: a letter of the phases of a programme.
struct SumoLight {
    int signal = -1;  // of SumoNet::signals; -1: always green
    int link = 0;
};

struct SumoNetwork {
    SumoNet net;  // without the shapes that the graph has
    LaneGraph graph;
    std::vector<SumoLight> lights;          // [signal group]
    std::vector<std::vector<int>> lane_of;  // [edge][index] lane of the graph; -1: no cars
    std::vector<int> approach_of;           // [edge] approach of the graph; -1: no cars

    double longest_cycle_s() const;
    double longest_green_s() const;
};

// `clearance_m`: between centre lines, below which vehicles touch. Throws InputError with file and line.
SumoNetwork make_sumo_network(SumoNet net, double clearance_m);

// Whether a letter lets vehicles go: G, g, s, o, O.
bool sumo_is_green(char letter);

}  // namespace stopline
