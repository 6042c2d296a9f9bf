// Converts a LaneGraph into the nodes, edges and connections of SUMO's plain XML files.
//
// Each approach lane or exit lane becomes a lane of a SUMO edge. A lane with a stop line ends there in SUMO. If the
// lane continues beyond its stop line in the graph, the stretch beyond the line becomes part of each connection that
// begins on the lane. So every path from a stop line to an exit lane keeps its length.
#pragma once

#include <string>
#include <vector>

#include "network/lane_graph.h"

namespace stopline {

struct PlainNode {
    std::string id;
    Point position = {};
    bool has_signal = false;
};

struct PlainEdge {
    std::string id;
    int from = -1;           // index of the node at its start
    int to = -1;             // index of the node at its end
    std::vector<int> lanes;  // its lanes in the graph, from the right as in SUMO
    double length_m = 0.0;
};

struct PlainConnection {
    int from = -1;             // lane of the graph where the connection begins
    int to = -1;               // lane of the graph where the connection ends
    int connection_lane = -1;  // lane of the graph between `from` and `to`; -1: `from` leads directly to `to`
    double length_m = 0.0;
    int node = -1;  // index of the node that the connection crosses
    int link = -1;  // number of the connection among the node's connections with a signal; -1: no signal
};

struct PlainNetwork {
    struct LanePosition {
        int edge = -1;
        int index = -1;  // lane index in the edge, from the right
    };
    std::vector<PlainNode> nodes;
    std::vector<PlainEdge> edges;
    std::vector<PlainConnection> connections;
    std::vector<LanePosition> position_of;  // [lane of the graph]; for a connection: position of its approach lane

    // Returns the id that SUMO gives to a lane of the graph.
    std::string lane_id(int lane) const;
};

// Converts the graph. Throws InputError if lanes of one edge differ in length (turn pockets), because all lanes of an
// edge have the same length in SUMO.
PlainNetwork plain_network(const LaneGraph& graph);

}  // namespace stopline
