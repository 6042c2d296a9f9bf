// Fastest routes through an imported network.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "sumo_import/sumo_graph.h"

namespace stopline {

class SumoRouter {
public:
    explicit SumoRouter(const SumoNetwork& network);

    // Returns the turn from one edge to another, or Turn::none if no connection joins the edges.
    Turn turn(int from, int to) const;
    // Returns the edges of the route with the least free-flow travel time, including `from` and `to`. Returns nothing
    // if there is no route. Dijkstra's algorithm (1959) searches backwards from `to`. Successive calls with the same
    // `to` are fast, because they share the shortest-path tree.
    std::optional<std::vector<int>> fastest_route(int from, int to);
    // Returns true if the edge is open to passenger cars.
    bool allows_cars(int edge) const { return network_.approach_of[static_cast<std::size_t>(edge)] >= 0; }

private:
    struct Link {
        int edge;
        Turn turn;
        double time_s;  // free-flow travel time in the junction
    };
    void settle(int target);

    const SumoNetwork& network_;
    std::vector<std::vector<Link>> successors_;    // [edge]
    std::vector<std::vector<Link>> predecessors_;  // [edge]
    std::vector<double> time_s_;                   // [edge] free-flow travel time
    // The next members are the shortest-path tree of the routes to the edge to_.
    int to_ = -1;
    std::vector<double> remaining_s_;           // [edge] travel time from the end of the edge to the end of to_
    std::vector<int> next_edge_;                // [edge] next edge of the fastest route
    std::vector<char> settled_;                 // [edge] 1: remaining_s_ of the edge is final
    std::vector<std::pair<double, int>> open_;  // min-heap of candidates: travel time and edge
};

}  // namespace stopline
