#include "sumo_export/edges.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
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

constexpr double kMinEdge_m = 1.0;  // shortest edge between the starts of two pockets
// Length of the connections between the edges of one approach, m. SUMO does not allow a shorter connection.
constexpr double kSplit_m = 0.1;

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
        network_.parts_of.resize(graph_.lanes.size());
        for (auto& [name, lanes] : lanes_of) {
            const Lane& first = graph_.lanes[at(lanes[0])];
            std::stable_sort(lanes.begin(), lanes.end(), [&](int a, int b) {
                return offset_to_the_right_m(graph_.lanes[at(a)], first) >
                       offset_to_the_right_m(graph_.lanes[at(b)], first);
            });
            for (const int k : lanes) {
                const Lane& lane = graph_.lanes[at(k)];
                if (std::abs(approach_end_m(lane) - approach_end_m(first)) < 1e-6) continue;
                throw InputError(
                    fmt::format("lanes '{}' and '{}' of one edge end at different positions; such networks cannot be "
                                "exported to SUMO",
                                lane.name, first.name));
            }
            add_edges(name, lanes);
        }
    }

    // Returns the positions at which the edges of an approach begin, measured from the start of the approach: 0, and
    // the starts of the pockets. If a pocket begins less than kMinEdge_m after another start, it begins at that start
    // in SUMO.
    std::vector<double> edge_starts_m(const std::vector<int>& lanes) const {
        std::vector<double> pockets_m;
        for (const int lane : lanes) pockets_m.push_back(graph_.lanes[at(lane)].start_offset_m);
        std::sort(pockets_m.begin(), pockets_m.end());
        std::vector<double> starts_m{0.0};
        for (const double pocket_m : pockets_m) {
            if (pocket_m >= starts_m.back() + kMinEdge_m) starts_m.push_back(pocket_m);
        }
        return starts_m;
    }

    // Adds the edges of one approach or exit in driving direction. `lanes` lists its lanes from the right. The last
    // edge gets the name `name`. Each other edge gets this name with a number.
    void add_edges(const std::string& name, const std::vector<int>& lanes) {
        const std::vector<double> starts_m = edge_starts_m(lanes);
        const double end_of_approach_m = approach_end_m(graph_.lanes[at(lanes[0])]);
        for (std::size_t k = 0; k < starts_m.size(); ++k) {
            const bool is_last = k + 1 == starts_m.size();
            PlainEdge edge;
            edge.id = is_last ? name : fmt::format("{}.{}", name, k + 1);
            edge.length_m = is_last ? end_of_approach_m - starts_m[k] : starts_m[k + 1] - starts_m[k] - kSplit_m;
            for (const int lane : lanes) {
                const Lane& own = graph_.lanes[at(lane)];
                if (own.start_offset_m >= starts_m[k] + kMinEdge_m) continue;
                const double from_m = std::max(starts_m[k] - own.start_offset_m, 0.0);
                network_.parts_of[at(lane)].push_back(
                    {static_cast<int>(network_.edges.size()), static_cast<int>(edge.lanes.size()), from_m});
                edge.lanes.push_back(lane);
                edge.ends_at_stop_line |= is_last && own.signal_group >= 0;
            }
            network_.edges.push_back(std::move(edge));
        }
    }

    // Returns the position where the lane ends in SUMO, measured from the start of its approach.
    static double approach_end_m(const Lane& lane) { return lane.start_offset_m + end_m(lane); }

    // Returns the position where the lane ends in SUMO, measured from the start of the lane: its stop line, or the end
    // of a lane without a stop line.
    static double end_m(const Lane& lane) { return lane.signal_group >= 0 ? lane.stop_line_m : lane.length_m; }

    void make_connections() {
        for (int from = 0; from < static_cast<int>(graph_.lanes.size()); ++from) {
            if (is_connection(from)) continue;
            connect_parts(from);
            const Lane& lane = graph_.lanes[at(from)];
            for (const int next : lane.next) {
                const bool through_junction = is_connection(next);
                const double shared_m = lane.length_m - end_m(lane);
                const int to = through_junction ? graph_.lanes[at(next)].next.front() : next;
                const double length_m = shared_m + (through_junction ? graph_.lanes[at(next)].length_m : 0.0);
                network_.connections.push_back(
                    {from, to, parts(from).back(), parts(to).front(), through_junction ? next : -1, length_m});
            }
        }
    }

    const std::vector<EdgePart>& parts(int lane) const { return network_.parts_of[at(lane)]; }

    // Connects the parts of a lane, and connects the lane to the pockets that begin beside it.
    void connect_parts(int lane) {
        for (std::size_t k = 0; k + 1 < parts(lane).size(); ++k) {
            const EdgePart& here = parts(lane)[k];
            const EdgePart& next = parts(lane)[k + 1];
            network_.connections.push_back({lane, lane, here, next, -1, kSplit_m});
            for (const int pocket : network_.edges[at(next.edge)].lanes) {
                const EdgePart& start = parts(pocket).front();
                if (start.edge == next.edge && nearest_lane(here.edge, start) == lane) {
                    network_.connections.push_back({lane, pocket, here, start, -1, kSplit_m});
                }
            }
        }
    }

    // Returns the lane on `edge` from which vehicles enter a pocket. It is the lane whose part on the next edge is
    // nearest to the pocket, counted in lanes. `pocket` is the first part of the pocket, which lies on the next edge.
    int nearest_lane(int edge, const EdgePart& pocket) const {
        int nearest = -1;
        int least = std::numeric_limits<int>::max();
        for (const int lane : network_.edges[at(edge)].lanes) {
            for (const EdgePart& part : parts(lane)) {
                const int lanes_between = std::abs(part.index - pocket.index);
                if (part.edge != pocket.edge || lanes_between >= least) continue;
                least = lanes_between;
                nearest = lane;
            }
        }
        return nearest;
    }

    // Makes the nodes. If a connection leads from one edge to another, the end of the first edge and the start of the
    // second edge belong to the same node (union-find).
    void make_nodes() {
        const int edges = static_cast<int>(network_.edges.size());
        parent_.resize(at(2 * edges));  // element 2 k is the start of edge k, and element 2 k + 1 is its end
        std::iota(parent_.begin(), parent_.end(), 0);
        for (const PlainConnection& c : network_.connections) {
            parent_[at(root(2 * c.begin.edge + 1))] = root(2 * c.end.edge);
        }
        std::map<int, int> node_of;
        for (int end = 0; end < 2 * edges; ++end) {
            const auto [entry, is_new] = node_of.emplace(root(end), static_cast<int>(network_.nodes.size()));
            if (is_new) network_.nodes.push_back({fmt::format("n{}", entry->second)});
            PlainEdge& edge = network_.edges[at(end / 2)];
            (end % 2 == 0 ? edge.from : edge.to) = entry->second;
        }
        place_nodes();
        for (PlainConnection& c : network_.connections) c.node = network_.edges[at(c.begin.edge)].to;
        number_links();
    }

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
        for (int k = 0; k < static_cast<int>(network_.edges.size()); ++k) {
            const PlainEdge& edge = network_.edges[at(k)];
            for (const int lane : edge.lanes) {
                const Lane& graph_lane = graph_.lanes[at(lane)];
                const double from_m = network_.part_on(lane, k).from_m;
                add(edge.from, pose_at(graph_lane.shape, graph_lane.shape_start_m + from_m).point);
                add(edge.to, pose_at(graph_lane.shape, graph_lane.shape_start_m + from_m + edge.length_m).point);
            }
            network_.nodes[at(edge.to)].has_signal |= edge.ends_at_stop_line;
        }
        for (std::size_t k = 0; k < point_counts.size(); ++k) {
            network_.nodes[k].position.x_m /= point_counts[k];
            network_.nodes[k].position.y_m /= point_counts[k];
        }
    }

    void number_links() {
        std::vector<int> links(network_.nodes.size());
        for (PlainConnection& c : network_.connections) {
            if (network_.edges[at(c.begin.edge)].ends_at_stop_line) c.link = links[at(c.node)]++;
        }
    }

    const LaneGraph& graph_;
    PlainNetwork network_;
    std::vector<int> parent_;  // [edge end] parent in the union-find forest, in which each tree is a node
};

}  // namespace

const EdgePart& PlainNetwork::part_on(int lane, int edge) const {
    const std::vector<EdgePart>& parts = parts_of[at(lane)];
    return *std::find_if(parts.begin(), parts.end(), [&](const EdgePart& part) { return part.edge == edge; });
}

const EdgePart& PlainNetwork::part_at(int lane, double position_m) const {
    const std::vector<EdgePart>& parts = parts_of[at(lane)];
    std::size_t k = 0;
    while (k + 1 < parts.size() && parts[k + 1].from_m <= position_m) ++k;
    return parts[k];
}

std::string PlainNetwork::lane_id(const EdgePart& part) const {
    return fmt::format("{}_{}", edges[at(part.edge)].id, part.index);
}

std::string PlainNetwork::lane_id(int lane) const { return lane_id(parts_of[at(lane)].back()); }

PlainNetwork plain_network(const LaneGraph& graph) { return Builder(graph).build(); }

}  // namespace stopline
