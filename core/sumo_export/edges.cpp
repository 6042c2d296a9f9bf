#include "sumo_export/edges.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <fmt/format.h>

#include "base/containers/index.h"
#include "base/input_error.h"

namespace stopline {

namespace {

// Returns the name of the edge to which a lane belongs, such as c1r0_south_in for the lane c1r0_south_in_0.
std::string edge_name(const Lane& lane) { return lane.name.substr(0, lane.name.rfind('_')); }

// Returns how far the start of a lane lies to the right of a reference lane, seen in driving direction.
double offset_to_the_right_m(const Lane& lane, const Lane& reference) {
    const Point& from = reference.shape.front();
    const Point& to = reference.shape.back();
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
    bool is_connection(int lane) const { return graph_.lanes[at(lane)].origin >= 0; }

    void make_edges() {
        std::map<std::string, std::vector<int>> lanes_of;
        for (int k = 0; k < static_cast<int>(graph_.lanes.size()); ++k) {
            if (!is_connection(k)) lanes_of[edge_name(graph_.lanes[at(k)])].push_back(k);
        }
        network_.position_of.assign(graph_.lanes.size(), {});
        for (auto& [name, lanes] : lanes_of) {
            const Lane& first = graph_.lanes[at(lanes[0])];
            std::stable_sort(lanes.begin(), lanes.end(), [&](int a, int b) {
                return offset_to_the_right_m(graph_.lanes[at(a)], first) >
                       offset_to_the_right_m(graph_.lanes[at(b)], first);
            });
            for (int k = 0; k < static_cast<int>(lanes.size()); ++k) {
                const Lane& lane = graph_.lanes[at(lanes[at(k)])];
                network_.position_of[at(lanes[at(k)])] = {static_cast<int>(network_.edges.size()), k};
                if (std::abs(end_m(lane) - end_m(first)) < 1e-6) continue;
                throw InputError(fmt::format(
                    "lanes '{}' and '{}' of one edge differ in length; networks with turn pockets cannot be "
                    "exported to SUMO",
                    lane.name, first.name));
            }
            network_.edges.push_back({name, -1, -1, lanes, end_m(first)});
        }
        for (std::size_t k = 0; k < graph_.lanes.size(); ++k) {
            if (is_connection(static_cast<int>(k)))
                network_.position_of[k] = network_.position_of[at(graph_.lanes[k].origin)];
        }
    }

    // Returns the position where the lane ends in SUMO: its stop line, or the end of a lane without a stop line.
    static double end_m(const Lane& lane) { return lane.signal_group >= 0 ? lane.stop_line_m : lane.length_m; }

    void make_connections() {
        for (int from = 0; from < static_cast<int>(graph_.lanes.size()); ++from) {
            if (is_connection(from)) continue;
            const Lane& lane = graph_.lanes[at(from)];
            for (const int next : lane.next) {
                const bool through_junction = is_connection(next);
                const double shared_m = lane.length_m - end_m(lane);
                const int to = through_junction ? graph_.lanes[at(next)].next.front() : next;
                const double length_m = shared_m + (through_junction ? graph_.lanes[at(next)].length_m : 0.0);
                network_.connections.push_back({from, to, through_junction ? next : -1, length_m});
            }
        }
    }

    // Makes the nodes. If a connection leads from one edge to another, the end of the first edge and the start of the
    // second edge belong to the same node (union-find).
    void make_nodes() {
        const int edges = static_cast<int>(network_.edges.size());
        parent_.resize(at(2 * edges));  // element 2 k is the start of edge k, and element 2 k + 1 is its end
        std::iota(parent_.begin(), parent_.end(), 0);
        for (const PlainConnection& c : network_.connections) {
            parent_[at(root(end_of(c.from)))] = root(2 * network_.position_of[at(c.to)].edge);
        }
        std::map<int, int> node_of;
        for (int end = 0; end < 2 * edges; ++end) {
            const auto [entry, is_new] = node_of.emplace(root(end), static_cast<int>(network_.nodes.size()));
            if (is_new) network_.nodes.push_back({fmt::format("n{}", entry->second)});
            PlainEdge& edge = network_.edges[at(end / 2)];
            (end % 2 == 0 ? edge.from : edge.to) = entry->second;
        }
        place_nodes();
        for (PlainConnection& c : network_.connections) c.node = network_.edges[at(end_of(c.from) / 2)].to;
        number_links();
    }

    // Returns the index in parent_ of the end of the lane's edge.
    int end_of(int lane) const { return 2 * network_.position_of[at(lane)].edge + 1; }

    // Returns the root of the tree of the edge end `end`. All edge ends of a node have the same root.
    int root(int end) {
        while (parent_[at(end)] != end) end = parent_[at(end)] = parent_[at(parent_[at(end)])];
        return end;
    }

    // Puts each node at the mean position of all starts and ends of lanes that meet at the node.
    void place_nodes() {
        std::vector<int> point_counts(network_.nodes.size());
        const auto add = [&](int node, const Point& point) {
            PlainNode& n = network_.nodes[at(node)];
            n.position = {n.position.x_m + point.x_m, n.position.y_m + point.y_m};
            ++point_counts[at(node)];
        };
        for (const PlainEdge& edge : network_.edges) {
            for (const int lane : edge.lanes) {
                const Lane& graph_lane = graph_.lanes[at(lane)];
                add(edge.from, pose_at(graph_lane.shape, graph_lane.shape_start_m).point);
                add(edge.to, pose_at(graph_lane.shape, graph_lane.shape_start_m + end_m(graph_lane)).point);
                network_.nodes[at(edge.to)].has_signal |= graph_lane.signal_group >= 0;
            }
        }
        for (std::size_t k = 0; k < point_counts.size(); ++k) {
            network_.nodes[k].position.x_m /= point_counts[k];
            network_.nodes[k].position.y_m /= point_counts[k];
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
    std::vector<int> parent_;  // [edge end] parent in the union-find forest, in which each tree is a node
};

}  // namespace

std::string PlainNetwork::lane_id(int lane) const {
    const LanePosition& position = position_of[at(lane)];
    return fmt::format("{}_{}", edges[at(position.edge)].id, position.index);
}

PlainNetwork plain_network(const LaneGraph& graph) { return Builder(graph).build(); }

}  // namespace stopline
