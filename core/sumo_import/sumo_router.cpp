#include "sumo_import/sumo_router.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <limits>
#include <utility>

#include "base/containers/index.h"

namespace stopline {

namespace {

constexpr double kUnreachable_s = std::numeric_limits<double>::infinity();
// Landmarks are edges whose travel times to and from all other edges are known. They make searches faster. Computing
// these times costs as much as 32 searches of the whole network, which is not worthwhile for a few routes.
constexpr int kSearchesBeforeLandmarks = 32;
// After this number of successive calls with the same destination, a shortest-path tree is faster than single searches.
constexpr int kCallsBeforeTree = 8;

void push(std::vector<std::pair<double, int>>& heap, double key, int edge) {
    heap.emplace_back(key, edge);
    std::push_heap(heap.begin(), heap.end(), std::greater<>());
}

std::pair<double, int> pop(std::vector<std::pair<double, int>>& heap) {
    std::pop_heap(heap.begin(), heap.end(), std::greater<>());
    const std::pair<double, int> top = heap.back();
    heap.pop_back();
    return top;
}

}  // namespace

SumoRouter::SumoRouter(const SumoNetwork& network) : network_(network), time_s_(network.net.edges.size(), 0.0) {
    const LaneGraph& graph = network.graph;
    std::vector<int> edge_of(graph.approaches.size(), -1);
    for (std::size_t edge = 0; edge < time_s_.size(); ++edge) {
        if (network.approach_of[edge] < 0) continue;
        edge_of[at(network.approach_of[edge])] = static_cast<int>(edge);
        const Lane& lane = graph.lanes[at(graph.approaches[at(network.approach_of[edge])].lanes[0])];
        time_s_[edge] = lane.stop_line_m / lane.limit_mps;
    }
    std::vector<std::vector<Link>> successors(time_s_.size());
    std::vector<std::vector<Link>> predecessors(time_s_.size());
    for (const Lane& lane : graph.lanes) {
        if (lane.origin < 0) continue;
        const int from = edge_of[at(graph.lanes[at(lane.origin)].approach)];
        const int to = edge_of[at(graph.lanes[at(lane.next[0])].approach)];
        std::vector<Link>& links = successors[at(from)];
        if (std::any_of(links.begin(), links.end(), [&](const Link& link) { return link.edge == to; })) continue;
        const double time_s = lane.length_m / lane.limit_mps;
        links.push_back({to, lane.turn, time_s});
        predecessors[at(to)].push_back({from, lane.turn, time_s});
    }
    for (const std::vector<Link>& links : successors) successors_.add(links);
    for (const std::vector<Link>& links : predecessors) predecessors_.add(links);
    remaining_s_.assign(time_s_.size(), kUnreachable_s);
    settled_.assign(time_s_.size(), 0);
}

Turn SumoRouter::turn(int from, int to) const {
    for (const Link& link : successors_.of(from)) {
        if (link.edge == to) return link.turn;
    }
    return Turn::none;
}

// Begins a search backwards from the edge `to`.
void SumoRouter::start(int to) {
    for (const int edge : changed_) {
        remaining_s_[at(edge)] = kUnreachable_s;
        settled_[at(edge)] = 0;
    }
    changed_.assign(1, to);
    remaining_s_[at(to)] = 0.0;
    open_.assign(1, {0.0, to});
}

// Extends the shortest-path tree backwards from the destination to_ until the fastest route from the edge `target` is
// known, or until the tree contains all edges from which the destination can be reached.
void SumoRouter::settle(int target) {
    while (settled_[at(target)] == 0 && !open_.empty()) {
        const int edge = pop(open_).second;
        if (settled_[at(edge)] != 0) continue;
        settled_[at(edge)] = 1;
        for (const Link& link : predecessors_.of(edge)) {
            const double candidate_s = remaining_s_[at(edge)] + time_s_[at(edge)] + link.time_s;
            if (candidate_s >= remaining_s_[at(link.edge)]) continue;
            if (remaining_s_[at(link.edge)] == kUnreachable_s) changed_.push_back(link.edge);
            remaining_s_[at(link.edge)] = candidate_s;
            push(open_, candidate_s, link.edge);
        }
    }
}

// Finds the travel time to the destination to_ for each edge on a fastest route from the edge `from` to the
// destination. The search ends when no further route with the least travel time can exist. If the search finds a faster
// route from an edge that it has already visited, it visits the edge again, so that rounding errors of the lower bounds
// do no harm.
void SumoRouter::search(int from) {
    constexpr double kRounding = 1e-9;
    choose_active(from);
    while (!open_.empty()) {
        const auto [bound_s, edge] = pop(open_);
        if (bound_s > remaining_s_[at(from)] * (1.0 + kRounding)) break;
        if (settled_[at(edge)] != 0) continue;
        settled_[at(edge)] = 1;
        for (const Link& link : predecessors_.of(edge)) {
            const double candidate_s = remaining_s_[at(edge)] + time_s_[at(edge)] + link.time_s;
            if (candidate_s >= remaining_s_[at(link.edge)]) continue;
            const double total_s = candidate_s + lower_bound_s(from, link.edge);
            if (total_s == kUnreachable_s) continue;
            if (remaining_s_[at(link.edge)] == kUnreachable_s) changed_.push_back(link.edge);
            remaining_s_[at(link.edge)] = candidate_s;
            settled_[at(link.edge)] = 0;
            push(open_, total_s, link.edge);
        }
    }
}

// Returns the edge that follows `edge` on the fastest route. If several routes are equally fast, returns the edge with
// the least remaining travel time. If these times are equal too, returns the edge with the lowest index.
int SumoRouter::next_edge(int edge) const {
    int best = -1;
    double best_s = kUnreachable_s;
    for (const Link& link : successors_.of(edge)) {
        const double candidate_s = remaining_s_[at(link.edge)] + time_s_[at(link.edge)] + link.time_s;
        const bool is_tie = candidate_s == best_s && best >= 0 &&
                            std::pair(remaining_s_[at(link.edge)], link.edge) < std::pair(remaining_s_[at(best)], best);
        if (candidate_s >= best_s && !is_tie) continue;
        best = link.edge;
        best_s = candidate_s;
    }
    return best;
}

std::vector<int> SumoRouter::route(int from) const {
    std::vector<int> edges{from};
    while (edges.back() != to_) edges.push_back(next_edge(edges.back()));
    return edges;
}

std::optional<std::vector<int>> SumoRouter::fastest_route(int from, int to) {
    if (to != to_) {
        to_ = to;
        requests_ = 0;
        is_tree_ = false;
    }
    if (++requests_ > kCallsBeforeTree && !is_tree_) {
        is_tree_ = true;
        start(to);
    }
    if (is_tree_) {
        settle(from);
        if (settled_[at(from)] == 0) return std::nullopt;
        return route(from);
    }
    if (landmarks_.empty() && ++searches_ > kSearchesBeforeLandmarks) choose_landmarks();
    start(to);
    search(from);
    if (remaining_s_[at(from)] == kUnreachable_s) return std::nullopt;
    return route(from);
}

// Returns a lower bound of the travel time between two edges. By the triangle inequality, the difference of the travel
// times from one landmark to both edges is such a bound, and so is the difference of the travel times from both edges
// to one landmark. The result is NaN if both times are infinite.
double SumoRouter::difference_s(float longer_s, float shorter_s) {
    constexpr double kRounding = 4.0 * static_cast<double>(std::numeric_limits<float>::epsilon());
    return static_cast<double>(longer_s) * (1.0 - kRounding) - static_cast<double>(shorter_s);
}

// Chooses the landmarks that give the highest lower bounds of the travel time from the edge `from` to the destination
// to_.
void SumoRouter::choose_active(int from) {
    active_count_ = 0;
    if (landmarks_.empty()) return;
    const LandmarkTimes& origin = landmarks_[at(from)];
    const LandmarkTimes& end = landmarks_[at(to_)];
    std::array<std::pair<double, std::size_t>, 2 * kLandmarks> bounds;
    for (std::size_t k = 0; k < kLandmarks; ++k) {
        bounds[k] = {difference_s(end.from_s[k], origin.from_s[k]), k};
        bounds[k + kLandmarks] = {difference_s(origin.to_s[k], end.to_s[k]), k + kLandmarks};
    }
    for (auto& [bound_s, k] : bounds) bound_s = bound_s > 0.0 ? bound_s : 0.0;  // also replaces NaN
    std::partial_sort(bounds.begin(), bounds.begin() + kActive, bounds.end(), std::greater<>());
    for (std::size_t k = 0; k < kActive; ++k) active_[k] = bounds[k].second;
    active_count_ = kActive;
}

// Returns a lower bound of the travel time from the end of the edge `from` to the end of `edge`.
double SumoRouter::lower_bound_s(int from, int edge) const {
    double best_s = 0.0;
    for (std::size_t k = 0; k < active_count_; ++k) {
        const LandmarkTimes& origin = landmarks_[at(from)];
        const LandmarkTimes& own = landmarks_[at(edge)];
        const std::size_t number = active_[k] % kLandmarks;
        const double bound_s = active_[k] < kLandmarks ? difference_s(own.from_s[number], origin.from_s[number])
                                                       : difference_s(origin.to_s[number], own.to_s[number]);
        if (bound_s > best_s) best_s = bound_s;  // false for NaN
    }
    return best_s;
}

// Returns the travel times from the end of `edge` to the ends of all edges. If `backwards` is true, returns the travel
// times from the ends of all edges to the end of `edge`.
std::vector<float> SumoRouter::travel_times_s(int edge, bool backwards) {
    std::vector<double> times_s(time_s_.size(), kUnreachable_s);
    times_s[at(edge)] = 0.0;
    std::vector<Candidate> open{{0.0, edge}};
    while (!open.empty()) {
        const auto [reached_s, here] = pop(open);
        if (reached_s > times_s[at(here)]) continue;
        for (const Link& link : backwards ? predecessors_.of(here) : successors_.of(here)) {
            const double candidate_s = reached_s + link.time_s + time_s_[at(backwards ? here : link.edge)];
            if (candidate_s >= times_s[at(link.edge)]) continue;
            times_s[at(link.edge)] = candidate_s;
            push(open, candidate_s, link.edge);
        }
    }
    return {times_s.begin(), times_s.end()};
}

// Chooses landmarks one after the other. Each landmark is as far as possible from the landmarks chosen before.
void SumoRouter::choose_landmarks() {
    int next = 0;
    while (!allows_cars(next)) ++next;
    landmarks_.resize(time_s_.size());
    constexpr float kNever_s = std::numeric_limits<float>::max();
    std::vector<float> nearest_s(time_s_.size(), kNever_s);  // [edge] least travel time from a landmark
    for (std::size_t k = 0; k < kLandmarks; ++k) {
        const std::vector<float> from_s = travel_times_s(next, false);
        const std::vector<float> to_s = travel_times_s(next, true);
        float farthest_s = 0.0F;
        for (std::size_t edge = 0; edge < landmarks_.size(); ++edge) {
            landmarks_[edge].from_s[k] = from_s[edge];
            landmarks_[edge].to_s[k] = to_s[edge];
            nearest_s[edge] = std::min(nearest_s[edge], from_s[edge]);
            if (nearest_s[edge] == kNever_s || nearest_s[edge] <= farthest_s) continue;
            farthest_s = nearest_s[edge];
            next = static_cast<int>(edge);
        }
        if (farthest_s == 0.0F) return;
    }
}

}  // namespace stopline
