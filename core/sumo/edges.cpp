#include "sumo/edges.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <fmt/format.h>

#include "base/input_error.h"

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

// c1r0_south_in_0 is a lane of c1r0_south_in.
std::string edge_name(const Lane& lane) { return lane.name.substr(0, lane.name.rfind('_')); }

// How far to the right of another lane's beginning, seen in its direction.
double to_the_right_m(const Lane& lane, const Lane& of) {
    const Point& from = of.shape.front();
    const Point& to = of.shape.back();
    const double along_m = std::hypot(to.x_m - from.x_m, to.y_m - from.y_m);
    const Point& point = lane.shape.front();
    return ((point.x_m - from.x_m) * (to.y_m - from.y_m) - (point.y_m - from.y_m) * (to.x_m - from.x_m)) / along_m;
}

class Builder {
public:
    explicit Builder(const LaneGraph& graph) : graph_(graph) {}

    PlainNetwork build() {
        make_edges();
        make_connections();
        make_nodes();
        return std::move(network_);
    }

private:
    bool is_inside(int lane) const { return graph_.lanes[at(lane)].origin >= 0; }

    void make_edges() {
        std::map<std::string, std::vector<int>> lanes_of;
        for (int k = 0; k < static_cast<int>(graph_.lanes.size()); ++k) {
            if (!is_inside(k)) lanes_of[edge_name(graph_.lanes[at(k)])].push_back(k);
        }
        network_.place_of.assign(graph_.lanes.size(), {});
        for (auto& [name, lanes] : lanes_of) {
            const Lane& first = graph_.lanes[at(lanes[0])];
            std::stable_sort(lanes.begin(), lanes.end(), [&](int a, int b) {
                return to_the_right_m(graph_.lanes[at(a)], first) > to_the_right_m(graph_.lanes[at(b)], first);
            });
            for (int k = 0; k < static_cast<int>(lanes.size()); ++k) {
                const Lane& lane = graph_.lanes[at(lanes[at(k)])];
                network_.place_of[at(lanes[at(k)])] = {static_cast<int>(network_.edges.size()), k};
                if (std::abs(end_m(lane) - end_m(first)) < 1e-6) continue;
                throw InputError(
                    fmt::format("lanes '{}' and '{}' of one edge differ in length: pockets cannot be exported",
                                lane.name, first.name));
            }
            network_.edges.push_back({name, -1, -1, lanes, end_m(first)});
        }
        for (std::size_t k = 0; k < graph_.lanes.size(); ++k) {
            if (is_inside(static_cast<int>(k))) network_.place_of[k] = network_.place_of[at(graph_.lanes[k].origin)];
        }
    }

    static double end_m(const Lane& lane) { return lane.signal_group >= 0 ? lane.stop_line_m : lane.length_m; }

    void make_connections() {
        for (int from = 0; from < static_cast<int>(graph_.lanes.size()); ++from) {
            if (is_inside(from)) continue;
            const Lane& lane = graph_.lanes[at(from)];
            for (const int next : lane.next) {
                const bool inside = is_inside(next);
                const double shared_m = lane.length_m - end_m(lane);
                const int to = inside ? graph_.lanes[at(next)].next.front() : next;
                const double length_m = shared_m + (inside ? graph_.lanes[at(next)].length_m : 0.0);
                network_.connections.push_back({from, to, inside ? next : -1, length_m});
            }
        }
    }

    // Ends of edges that connections join are one node.
    void make_nodes() {
        const int edges = static_cast<int>(network_.edges.size());
        joined_.resize(at(2 * edges));  // the beginning of each edge, then its end
        std::iota(joined_.begin(), joined_.end(), 0);
        for (const PlainConnection& c : network_.connections) {
            joined_[at(root(end_of(c.from)))] = root(2 * network_.place_of[at(c.to)].edge);
        }
        std::map<int, int> node_of;
        for (int end = 0; end < 2 * edges; ++end) {
            const auto [place, is_new] = node_of.emplace(root(end), static_cast<int>(network_.nodes.size()));
            if (is_new) network_.nodes.push_back({fmt::format("n{}", place->second)});
            PlainEdge& edge = network_.edges[at(end / 2)];
            (end % 2 == 0 ? edge.from : edge.to) = place->second;
        }
        place_nodes();
        for (PlainConnection& c : network_.connections) c.node = network_.edges[at(end_of(c.from) / 2)].to;
        number_links();
    }

    int end_of(int lane) const { return 2 * network_.place_of[at(lane)].edge + 1; }

    int root(int end) {
        while (joined_[at(end)] != end) end = joined_[at(end)] = joined_[at(joined_[at(end)])];
        return end;
    }

    // In the middle of the ends of all lanes.
    void place_nodes() {
        std::vector<int> points(network_.nodes.size());
        const auto add = [&](int node, const Point& point) {
            PlainNode& n = network_.nodes[at(node)];
            n.at = {n.at.x_m + point.x_m, n.at.y_m + point.y_m};
            ++points[at(node)];
        };
        for (const PlainEdge& edge : network_.edges) {
            for (const int lane : edge.lanes) {
                const Lane& road = graph_.lanes[at(lane)];
                add(edge.from, place_at(road.shape, road.shape_start_m).point);
                add(edge.to, place_at(road.shape, road.shape_start_m + end_m(road)).point);
                network_.nodes[at(edge.to)].lights |= road.signal_group >= 0;
            }
        }
        for (std::size_t k = 0; k < points.size(); ++k) {
            network_.nodes[k].at.x_m /= points[k];
            network_.nodes[k].at.y_m /= points[k];
        }
    }

    void number_links() {
        std::vector<int> links(network_.nodes.size());
        for (PlainConnection& c : network_.connections) {
            if (graph_.lanes[at(c.from)].signal_group >= 0) c.link = links[at(c.node)]++;
        }
    }

    const LaneGraph& graph_;
    PlainNetwork network_;
    std::vector<int> joined_;
};

}  // namespace

std::string PlainNetwork::lane_id(int lane) const {
    const Place& place = place_of[at(lane)];
    return fmt::format("{}_{}", edges[at(place.edge)].id, place.index);
}

PlainNetwork plain_network(const LaneGraph& graph) { return Builder(graph).build(); }

}  // namespace stopline
