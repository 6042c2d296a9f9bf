// Ways through an imported network, edge by edge.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "network/sumo_graph.h"

namespace stopline {

class SumoRouter {
public:
    explicit SumoRouter(const SumoNetwork& network);

    // The turn by which one goes on from an edge to another; none: one cannot.
    Turn turn(int from, int to) const;
    // The edges from `from` to `to`, both included, that take the least time without other traffic (Dijkstra 1959, from the end; trees are
    // kept as long as the end stays the same). None: there is no way.
    std::optional<std::vector<int>> way(int from, int to);
    bool drives(int edge) const { return network_.approach_of[static_cast<std::size_t>(edge)] >= 0; }

private:
    struct Link {
        int edge;
        Turn turn;
        double time_s;  // in the junction
    };
    void grow(int until);

    const SumoNetwork& network_;
    std::vector<std::vector<Link>> next_;    // [edge]
    std::vector<std::vector<Link>> before_;  // [edge]
    std::vector<double> time_s_;             // [edge] along it
    int to_ = -1;
    std::vector<double> left_s_;                // [edge] from its end to that of to_
    std::vector<int> onward_;                   // [edge]
    std::vector<char> settled_;                 // [edge]
    std::vector<std::pair<double, int>> open_;  // a heap, the least first
};

}  // namespace stopline
