// Converts a LaneGraph into the nodes, edges and connections of SUMO's plain XML files.
//
// Each approach lane or exit lane becomes a lane of a SUMO edge. A lane with a stop line ends at this line in SUMO. If
// the lane continues beyond its stop line in the graph, the stretch beyond the line becomes part of each connection
// that begins on the lane. So every path from a stop line to an exit lane keeps its length.
//
// All lanes of a SUMO edge are equally long. So an approach with turn pockets becomes several edges, one behind the
// other. A new edge begins where a pocket begins. At this point, the lane beside the pocket leads both straight on and
// into the pocket.
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
    bool ends_at_stop_line = false;
};

// The part of a lane of the graph that lies on one edge.
struct EdgePart {
    int edge = -1;
    int index = -1;       // lane index in the edge, from the right
    double from_m = 0.0;  // start of the part, measured on the lane of the graph
};

struct PlainConnection {
    int from = -1;             // lane of the graph where the connection begins
    int to = -1;               // lane of the graph where it ends; equal to `from` if it joins two parts of this lane
    EdgePart begin = {};       // the connection begins at the end of this part
    EdgePart end = {};         // the connection ends at the start of this part
    int connection_lane = -1;  // lane of the graph between `from` and `to`; -1: `from` leads directly to `to`
    double length_m = 0.0;
    int node = -1;  // index of the node that the connection crosses
    int link = -1;  // number of the connection among the node's connections with a signal; -1: no signal
};

struct PlainNetwork {
    std::vector<PlainNode> nodes;
    std::vector<PlainEdge> edges;
    std::vector<PlainConnection> connections;
    std::vector<std::vector<EdgePart>> parts_of;  // [lane of the graph] in driving direction; empty for connections

    // Returns the last part of the lane that begins at or before `position_m`.
    const EdgePart& part_at(int lane, double position_m) const;
    // Returns the part of the lane that lies on the edge. There must be one.
    const EdgePart& part_on(int lane, int edge) const;
    // Return the id of a lane in SUMO: of the given part, or of the last part of a lane of the graph.
    std::string lane_id(const EdgePart& part) const;
    std::string lane_id(int lane) const;
};

// Converts the graph. Throws InputError if lanes of one approach end at different positions.
PlainNetwork plain_network(const LaneGraph& graph);

}  // namespace stopline
