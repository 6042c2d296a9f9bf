#include "sumo_import/sumo_short_edges.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "base/containers/index.h"

namespace stopline {

namespace {

class Merger {
public:
    explicit Merger(SumoNet& net)
        : net_(net), outgoing_(net.edges.size()), incoming_(net.edges.size()), loops_(net.edges.size()) {
        for (std::size_t k = 0; k < net.loops.size(); ++k) loops_[at(net.loops[k].edge)].push_back(k);
        for (std::size_t k = 0; k < net.connections.size(); ++k) {
            const SumoConnection& c = net.connections[k];
            if (net.edges[at(c.from)].internal) {
                next_in_chain_[{c.from, c.from_lane}] = k;
            } else if (!net.edges[at(c.to)].internal) {
                outgoing_[at(c.from)].push_back(k);
                incoming_[at(c.to)].push_back(k);
            }
        }
    }

    void merge_all() {
        for (const std::vector<std::size_t>& connections : outgoing_) {
            for (const std::size_t k : connections) {
                const SumoConnection& c = connection(k);
                if (lane_of({c.from, c.from_lane}).allows_cars && lane_of({c.to, c.to_lane}).allows_cars)
                    add_links(c, car_links_);
            }
        }
        for (std::size_t edge = 0; edge < net_.edges.size(); ++edge) try_to_merge(static_cast<int>(edge));
        std::vector<SumoConnection> kept;
        for (SumoConnection& c : net_.connections) {
            if (c.from >= 0) kept.push_back(std::move(c));
        }
        net_.connections = std::move(kept);
    }

private:
    using LaneId = std::pair<int, int>;  // edge and index of a lane
    using Link = std::pair<int, int>;    // SUMO's link: junction, and index of a connection in its matrix
    using Links = std::set<Link>;

    const SumoConnection& connection(std::size_t k) const { return net_.connections[k]; }
    const SumoLane& lane_of(const LaneId& id) const { return net_.edges[at(id.first)].lanes[at(id.second)]; }

    // SUMO writes 't' for a turnaround, and 'T' for one in a network with left-hand traffic.
    static bool is_u_turn(const SumoConnection& c) { return c.dir == 't' || c.dir == 'T'; }

    void try_to_merge(int edge) {
        SumoEdge& own = net_.edges[at(edge)];
        if (own.internal || own.lanes[0].length_m >= kShortEdge_m || incoming_[at(edge)].empty() ||
            outgoing_[at(edge)].empty())
            return;
        const int before = connection(incoming_[at(edge)][0]).from;
        const auto continues_before = [&](std::size_t k) {
            const SumoConnection& c = connection(k);
            return c.from == before && c.tl < 0 && !is_u_turn(c);
        };
        const auto to_edge = [&](std::size_t k) { return connection(k).to == edge; };
        const auto is_reached_with_via = [&](std::size_t k) {
            const auto leads_to_origin = [&](std::size_t in) {
                return connection(in).to_lane == connection(k).from_lane;
            };
            return connection(k).via >= 0 &&
                   std::any_of(incoming_[at(edge)].begin(), incoming_[at(edge)].end(), leads_to_origin);
        };
        const auto all = [](const std::vector<std::size_t>& connections, const auto& holds) {
            return std::all_of(connections.begin(), connections.end(), holds);
        };
        if (before == edge || !all(incoming_[at(edge)], continues_before)) return;
        if (!all(outgoing_[at(before)], to_edge) || !all(outgoing_[at(edge)], is_reached_with_via)) return;
        if (has_crossing_traffic(incoming_[at(edge)])) return;
        merge(before, edge);
    }

    // Returns true if another connection for cars conflicts with one of `connections` in its junction. The merged lane
    // has no conflict areas, so vehicles of both would drive through each other.
    bool has_crossing_traffic(const std::vector<std::size_t>& connections) const {
        Links own;
        for (const std::size_t k : connections) add_links(connection(k), own);
        return std::any_of(own.begin(), own.end(), [&](const Link& link) {
            const std::vector<std::vector<bool>>& foes = net_.junctions[at(link.first)].foes;
            if (at(link.second) >= foes.size()) return false;
            for (int other = 0; at(other) < foes.size(); ++other) {
                const Link crossing{link.first, other};
                if (foes[at(link.second)][at(other)] && car_links_.contains(crossing) && !own.contains(crossing))
                    return true;
            }
            return false;
        });
    }

    // Adds the links of SUMO's junctions that the connection passes.
    void add_links(const SumoConnection& c, Links& links) const {
        for (const auto& [internal_edge, lane] : via_lanes(c)) {
            const auto link = net_.link_of.find(fmt::format("{}_{}", net_.edges[at(internal_edge)].id, lane));
            if (link != net_.link_of.end()) links.insert(link->second);
        }
    }

    // Returns the internal lanes of a connection, in driving order.
    std::vector<LaneId> via_lanes(const SumoConnection& c) const {
        constexpr std::size_t kMaxLanes = 16;
        std::vector<LaneId> lanes;
        int via = c.via;
        int lane = c.via_lane;
        while (via >= 0 && lanes.size() < kMaxLanes) {
            lanes.emplace_back(via, lane);
            const auto next = next_in_chain_.find({via, lane});
            via = next == next_in_chain_.end() ? -1 : connection(next->second).via;
            lane = next == next_in_chain_.end() ? 0 : connection(next->second).via_lane;
        }
        return lanes;
    }

    // Merges `edge` into the edge `before`.
    void merge(int before, int edge) {
        SumoEdge& predecessor = net_.edges[at(before)];
        const SumoEdge own = net_.edges[at(edge)];
        std::vector<bool> grown(predecessor.lanes.size(), false);
        double growth_m = 0.0;
        std::vector<SumoConnection> new_connections;
        move_loops(before, edge);
        for (const std::size_t in : incoming_[at(edge)]) {
            const SumoConnection c = connection(in);
            SumoLane& lane = predecessor.lanes[at(c.from_lane)];
            double added_m = own.lanes[at(c.to_lane)].length_m;
            std::vector<LaneId> parts = via_lanes(c);
            for (const LaneId& part : parts) added_m += lane_of(part).length_m;
            parts.emplace_back(edge, c.to_lane);
            add_end_lane(lane, own, c.to_lane, !grown[at(c.from_lane)]);
            if (!grown[at(c.from_lane)]) {
                add_merged_lanes({before, c.from_lane}, parts);
                for (const LaneId& part : parts) sumo_append(lane.shape, lane_of(part).shape);
                growth_m = std::max(growth_m, added_m);
            }
            grown[at(c.from_lane)] = true;
            for (const std::size_t out : outgoing_[at(edge)]) {
                if (connection(out).from_lane != c.to_lane) continue;
                new_connections.push_back(connection(out));
                new_connections.back().from = before;
                new_connections.back().from_lane = c.from_lane;
            }
        }
        for (std::size_t k = 0; k < grown.size(); ++k) {
            if (!grown[k]) add_merged_lanes({before, static_cast<int>(k)}, {});
            predecessor.lanes[k].length_m += growth_m;
        }
        replace_connections(before, edge, std::move(new_connections));
    }

    // Appends the names and lengths of the lanes `parts` to those of the merged lane `first`.
    void add_merged_lanes(const LaneId& first, const std::vector<LaneId>& parts) {
        std::vector<std::pair<std::string, double>>& merged =
            net_.edges[at(first.first)].lanes[at(first.second)].merged_lanes;
        const auto append = [&](const LaneId& id) {
            const SumoLane& lane = lane_of(id);
            if (lane.merged_lanes.empty()) {
                merged.emplace_back(fmt::format("{}_{}", net_.edges[at(id.first)].id, id.second), lane.length_m);
            } else {
                merged.insert(merged.end(), lane.merged_lanes.begin(), lane.merged_lanes.end());
            }
        };
        if (merged.empty()) append(first);
        for (const LaneId& part : parts) append(part);
    }

    // Records that, after the merge, `lane` ends where lane number `index` of the edge `merged` ends. If `replace` is
    // true, removes the ends of `lane` that were recorded before.
    static void add_end_lane(SumoLane& lane, const SumoEdge& merged, int index, bool replace) {
        if (replace) lane.end_lanes.clear();
        const SumoLane& last = merged.lanes[at(index)];
        std::vector<std::string> ends = last.end_lanes;
        if (ends.empty()) ends.push_back(fmt::format("{}_{}", merged.id, index));
        lane.end_lanes.insert(lane.end_lanes.end(), ends.begin(), ends.end());
    }

    // Moves the detectors of the merged edge `edge` to the edge `before`. Their places on the road stay the same.
    void move_loops(int before, int edge) {
        const std::vector<std::size_t> loops = std::move(loops_[at(edge)]);
        for (const std::size_t number : loops) {
            SumoLoop& loop = net_.loops[number];
            const auto leads_to_loop = [&](std::size_t k) { return connection(k).to_lane == loop.lane; };
            const auto in = std::find_if(incoming_[at(edge)].begin(), incoming_[at(edge)].end(), leads_to_loop);
            if (in == incoming_[at(edge)].end()) continue;  // no connection leads to the lane of the detector
            const SumoConnection& c = connection(*in);
            loop.edge = before;
            loops_[at(before)].push_back(number);
            loop.lane = c.from_lane;
            loop.position_m += net_.edges[at(before)].lanes[at(c.from_lane)].length_m;
            for (const LaneId& part : via_lanes(c)) loop.position_m += lane_of(part).length_m;
        }
    }

    // Adds `new_connections`, which replace the connections from `before` to `edge` and the connections that leave
    // `edge`. Closes `edge`, which has been merged into `before`, to cars.
    void replace_connections(int before, int edge, std::vector<SumoConnection> new_connections) {
        for (const std::size_t removed : incoming_[at(edge)]) net_.connections[removed].from = -1;
        for (const std::size_t removed : outgoing_[at(edge)]) net_.connections[removed].from = -1;
        const auto is_removed = [&](std::size_t k) { return connection(k).from < 0; };
        for (const std::size_t removed : outgoing_[at(edge)])
            std::erase_if(incoming_[at(connection(removed).to)], is_removed);
        outgoing_[at(before)].clear();
        outgoing_[at(edge)].clear();
        incoming_[at(edge)].clear();
        for (SumoConnection& c : new_connections) {
            outgoing_[at(before)].push_back(net_.connections.size());
            incoming_[at(c.to)].push_back(net_.connections.size());
            net_.connections.push_back(std::move(c));
        }
        net_.edges[at(edge)].merged_into = before;
        for (SumoLane& lane : net_.edges[at(edge)].lanes) lane.allows_cars = false;
    }

    SumoNet& net_;
    std::vector<std::vector<std::size_t>> outgoing_;            // [edge] connections from the edge to other edges
    std::vector<std::vector<std::size_t>> incoming_;            // [edge] connections from other edges to the edge
    Links car_links_;                                           // links of connections that are open to cars
    std::vector<std::vector<std::size_t>> loops_;               // [edge] detectors on the edge
    std::map<std::pair<int, int>, std::size_t> next_in_chain_;  // [internal edge, lane] connection from this lane
};

}  // namespace

void merge_short_edges(SumoNet& net) { Merger(net).merge_all(); }

}  // namespace stopline
