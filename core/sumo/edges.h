// Our lanes as SUMO has them: side by side in edges between nodes, linked by connections through nodes.
//
// A lane that is not inside an intersection is a lane of an edge as far as its stop line; what lies behind that, shared by its
// movements, is a part of each connection, as is the lane inside. So the way from stop line to exit is as long as ours.
#pragma once

#include <string>
#include <vector>

#include "network/lane_graph.h"

namespace stopline {

struct PlainNode {
    std::string id;
    Point at = {};
    bool lights = false;
};

struct PlainEdge {
    std::string id;
    int from = -1;  // nodes
    int to = -1;
    std::vector<int> lanes;  // of the graph, from the right: SUMO's order
    double length_m = 0.0;
};

struct PlainConnection {
    int from = -1;  // lanes of the graph
    int to = -1;
    int way = -1;  // lane inside the intersection; -1: one follows the other at once
    double length_m = 0.0;
    int node = -1;
    int link = -1;  // index among those of the node that have a light; -1: none
};

struct PlainNetwork {
    struct Place {
        int edge = -1;
        int index = -1;  // from the right
    };
    std::vector<PlainNode> nodes;
    std::vector<PlainEdge> edges;
    std::vector<PlainConnection> connections;
    std::vector<Place> place_of;  // [lane]; inside an intersection: of the lane that leads there

    std::string lane_id(int lane) const;
};

// Throws InputError for what cannot be said in SUMO's files: lanes of one edge that differ in length (pockets).
PlainNetwork plain_network(const LaneGraph& graph);

}  // namespace stopline
