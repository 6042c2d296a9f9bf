#include "sumo_import/sumo_router.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <limits>
#include <utility>

#include "base/containers/index.h"

namespace stopline {

SumoRouter::SumoRouter(const SumoNetwork& network)
    : network_(network),
      successors_(network.net.edges.size()),
      predecessors_(network.net.edges.size()),
      time_s_(network.net.edges.size(), 0.0) {
    const LaneGraph& graph = network.graph;
    std::vector<int> edge_of(graph.approaches.size(), -1);
    for (std::size_t edge = 0; edge < time_s_.size(); ++edge) {
        if (network.approach_of[edge] < 0) continue;
        edge_of[at(network.approach_of[edge])] = static_cast<int>(edge);
        const Lane& lane = graph.lanes[at(graph.approaches[at(network.approach_of[edge])].lanes[0])];
        time_s_[edge] = lane.stop_line_m / lane.limit_mps;
    }
    for (const Lane& lane : graph.lanes) {
        if (lane.origin < 0) continue;
        const int from = edge_of[at(graph.lanes[at(lane.origin)].approach)];
        const int to = edge_of[at(graph.lanes[at(lane.next[0])].approach)];
        if (turn(from, to) != Turn::none) continue;
        const double time_s = lane.length_m / lane.limit_mps;
        successors_[at(from)].push_back({to, lane.turn, time_s});
        predecessors_[at(to)].push_back({from, lane.turn, time_s});
    }
}

Turn SumoRouter::turn(int from, int to) const {
    for (const Link& link : successors_[at(from)]) {
        if (link.edge == to) return link.turn;
    }
    return Turn::none;
}

// Extends the shortest-path tree backwards from to_ until the fastest route from the edge `target` to to_ is known, or
// until the tree contains all edges from which to_ can be reached.
void SumoRouter::settle(int target) {
    while (settled_[at(target)] == 0 && !open_.empty()) {
        std::pop_heap(open_.begin(), open_.end(), std::greater<>());
        const auto [remaining_s, edge] = open_.back();
        open_.pop_back();
        if (settled_[at(edge)] != 0) continue;
        settled_[at(edge)] = 1;
        for (const Link& link : predecessors_[at(edge)]) {
            const double candidate_s = remaining_s + time_s_[at(edge)] + link.time_s;
            if (settled_[at(link.edge)] != 0 || candidate_s >= remaining_s_[at(link.edge)]) continue;
            remaining_s_[at(link.edge)] = candidate_s;
            next_edge_[at(link.edge)] = edge;
            open_.emplace_back(candidate_s, link.edge);
            std::push_heap(open_.begin(), open_.end(), std::greater<>());
        }
    }
}

std::optional<std::vector<int>> SumoRouter::fastest_route(int from, int to) {
    if (to != to_) {
        to_ = to;
        remaining_s_.assign(time_s_.size(), std::numeric_limits<double>::infinity());
        next_edge_.assign(time_s_.size(), -1);
        settled_.assign(time_s_.size(), 0);
        remaining_s_[at(to)] = 0.0;
        open_.assign(1, {0.0, to});
    }
    settle(from);
    if (settled_[at(from)] == 0) return std::nullopt;
    std::vector<int> edges{from};
    while (edges.back() != to) edges.push_back(next_edge_[at(edges.back())]);
    return edges;
}

}  // namespace stopline
