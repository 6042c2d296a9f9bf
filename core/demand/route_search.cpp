#include "demand/route_search.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <queue>
#include <utility>

#include "base/containers/index.h"

namespace stopline {

namespace {

double free_flow_s(const Lane& lane) { return lane.length_m / lane.limit_mps; }

}  // namespace

std::string leg_name(const std::string& lane) {
    for (const char* const direction : {"_in_", "_out_"}) {
        const std::size_t end = lane.rfind(direction);
        if (end != std::string::npos) return lane.substr(0, end);
    }
    return lane.substr(0, lane.rfind('_'));
}

ShortestPaths::ShortestPaths(const LaneGraph& graph, int from_approach)
    : graph_(graph),
      from_approach_(from_approach),
      time_s_(graph.approaches.size(), kUnreached_s),
      previous_(graph.approaches.size(), -1) {
    std::vector<std::vector<int>> routes(graph.approaches.size());
    for (int route = 0; route < static_cast<int>(graph.routes.size()); ++route) {
        routes[at(graph.lanes[at(graph.routes[at(route)].lanes[0])].approach)].push_back(route);
    }
    using Reached = std::pair<double, int>;  // time, approach
    std::priority_queue<Reached, std::vector<Reached>, std::greater<>> queue;
    time_s_[at(from_approach)] = 0.0;
    queue.emplace(0.0, from_approach);
    while (!queue.empty()) {
        const auto [time_s, approach] = queue.top();
        queue.pop();
        if (time_s > time_s_[at(approach)]) continue;
        for (const int route : routes[at(approach)]) {
            const std::vector<int>& lanes = graph.routes[at(route)].lanes;
            double arrival_s = time_s;
            for (std::size_t k = 0; k + 1 < lanes.size(); ++k) arrival_s += free_flow_s(graph.lanes[at(lanes[k])]);
            const Lane& last = graph.lanes[at(lanes.back())];
            if (last.approach < 0) {
                exits_.push_back({leg_name(last.name), route, arrival_s + free_flow_s(last)});
            } else if (arrival_s < time_s_[at(last.approach)]) {
                time_s_[at(last.approach)] = arrival_s;
                previous_[at(last.approach)] = route;
                queue.emplace(arrival_s, last.approach);
            }
        }
    }
}

std::optional<NetworkPath> ShortestPaths::to(const std::string& leg) const {
    const Exit* best = nullptr;
    for (const Exit& exit : exits_) {
        if (exit.leg == leg && (best == nullptr || exit.time_s < best->time_s)) best = &exit;
    }
    if (best == nullptr) return std::nullopt;
    NetworkPath path{{}, best->time_s};
    for (int route = best->route; route >= 0;) {
        path.routes.push_back(route);
        const int approach = graph_.lanes[at(graph_.routes[at(route)].lanes[0])].approach;
        route = approach == from_approach_ ? -1 : previous_[at(approach)];
    }
    std::reverse(path.routes.begin(), path.routes.end());
    return path;
}

}  // namespace stopline
