// Converts a LaneGraph into the nodes, edges and connections of SUMO's plain XML files.
//
// An approach lane or exit lane becomes a lane of an edge, up to its stop line. The stretch beyond the stop line
// becomes part of every connection of the lane. So each path from a stop line to an exit lane keeps its length.
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
    int from = -1;           // node
    int to = -1;             // node
    std::vector<int> lanes;  // lanes of the graph, from the right as in SUMO
    double length_m = 0.0;
};

struct PlainConnection {
    int from = -1;             // lane of the graph
    int to = -1;               // lane of the graph
    int connection_lane = -1;  // lane of the graph inside the intersection; -1: none
    double length_m = 0.0;
    int node = -1;
    int link = -1;  // index among the node's connections with a signal; -1: no signal
};

struct PlainNetwork {
    struct LanePosition {
        int edge = -1;
        int index = -1;  // lane index in the edge, from the right
    };
    std::vector<PlainNode> nodes;
    std::vector<PlainEdge> edges;
    std::vector<PlainConnection> connections;
    std::vector<LanePosition> position_of;  // [lane of the graph]; a connection has the position of its approach lane

    // Returns the id that SUMO gives to a lane of the graph.
    std::string lane_id(int lane) const;
};

// Converts the graph. Throws InputError if lanes of one edge differ in length (turn pockets), because SUMO's files
// cannot express that.
PlainNetwork plain_network(const LaneGraph& graph);

}  // namespace stopline
