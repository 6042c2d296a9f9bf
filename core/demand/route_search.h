// Finds the shortest way through a network, by free-flow time.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "network/lane_graph.h"

namespace stopline {

// A way from an approach to the border of the network: one route for each intersection. The first lane of a route is
// any lane of the approach that allows the turn, because vehicles change lanes within an approach.
struct NetworkPath {
    std::vector<int> routes;
    double time_s = 0.0;  // free-flow time from the start of the first approach to the end of the last lane
};

// Returns the name of the leg of a lane, such as "c0r0_west" for c0r0_west_in_0 and c0r0_west_out_1. A lane without
// "_in_" or "_out_" in its name belongs to the leg with its name up to the last '_'.
std::string leg_name(const std::string& lane);

// The shortest ways from one approach to all legs where vehicles leave the network. Uses Dijkstra's algorithm.
class ShortestPaths {
public:
    // Each lane on which a route begins must have an approach.
    ShortestPaths(const LaneGraph& graph, int from_approach);

    // Returns the shortest path to a leg, or nothing if no path leads there.
    std::optional<NetworkPath> to(const std::string& leg) const;

private:
    static constexpr double kUnreached_s = std::numeric_limits<double>::infinity();
    struct Exit {
        std::string leg;
        int route;
        double time_s;  // from the start
    };

    const LaneGraph& graph_;
    int from_approach_;
    std::vector<double> time_s_;  // [approach] time from the start until its beginning
    std::vector<int> previous_;   // [approach] last route of the way that leads there; -1: none
    std::vector<Exit> exits_;
};

}  // namespace stopline
