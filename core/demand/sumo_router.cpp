#include "demand/sumo_router.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <limits>
#include <utility>

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

}  // namespace

SumoRouter::SumoRouter(const SumoNetwork& network)
    : network_(network),
      next_(network.net.edges.size()),
      before_(network.net.edges.size()),
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
        next_[at(from)].push_back({to, lane.turn, time_s});
        before_[at(to)].push_back({from, lane.turn, time_s});
    }
}

Turn SumoRouter::turn(int from, int to) const {
    for (const Link& link : next_[at(from)]) {
        if (link.edge == to) return link.turn;
    }
    return Turn::none;
}

// Until an edge is settled, or all that lead to the end are.
void SumoRouter::grow(int until) {
    while (settled_[at(until)] == 0 && !open_.empty()) {
        std::pop_heap(open_.begin(), open_.end(), std::greater<>());
        const auto [left_s, edge] = open_.back();
        open_.pop_back();
        if (settled_[at(edge)] != 0) continue;
        settled_[at(edge)] = 1;
        for (const Link& link : before_[at(edge)]) {
            const double more_s = left_s + time_s_[at(edge)] + link.time_s;
            if (settled_[at(link.edge)] != 0 || more_s >= left_s_[at(link.edge)]) continue;
            left_s_[at(link.edge)] = more_s;
            onward_[at(link.edge)] = edge;
            open_.emplace_back(more_s, link.edge);
            std::push_heap(open_.begin(), open_.end(), std::greater<>());
        }
    }
}

std::optional<std::vector<int>> SumoRouter::way(int from, int to) {
    if (to != to_) {
        to_ = to;
        left_s_.assign(time_s_.size(), std::numeric_limits<double>::infinity());
        onward_.assign(time_s_.size(), -1);
        settled_.assign(time_s_.size(), 0);
        left_s_[at(to)] = 0.0;
        open_.assign(1, {0.0, to});
    }
    grow(from);
    if (settled_[at(from)] == 0) return std::nullopt;
    std::vector<int> edges{from};
    while (edges.back() != to) edges.push_back(onward_[at(edges.back())]);
    return edges;
}

}  // namespace stopline
