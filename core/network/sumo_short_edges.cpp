#include "network/sumo_short_edges.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

class Joiner {
public:
    explicit Joiner(SumoNet& net) : net_(net), out_(net.edges.size()), in_(net.edges.size()) {
        for (std::size_t k = 0; k < net.connections.size(); ++k) {
            const SumoConnection& c = net.connections[k];
            if (net.edges[at(c.from)].internal) {
                onward_[{c.from, c.from_lane}] = k;
            } else if (!net.edges[at(c.to)].internal) {
                out_[at(c.from)].push_back(k);
                in_[at(c.to)].push_back(k);
            }
        }
    }

    void join() {
        for (std::size_t edge = 0; edge < net_.edges.size(); ++edge) try_to_join(static_cast<int>(edge));
        std::vector<SumoConnection> kept;
        for (SumoConnection& c : net_.connections) {
            if (c.from >= 0) kept.push_back(std::move(c));
        }
        net_.connections = std::move(kept);
    }

private:
    const SumoConnection& connection(std::size_t k) const { return net_.connections[k]; }

    void try_to_join(int edge) {
        SumoEdge& own = net_.edges[at(edge)];
        if (own.internal || own.lanes[0].length_m >= kShortEdge_m || in_[at(edge)].empty() || out_[at(edge)].empty())
            return;
        const int before = connection(in_[at(edge)][0]).from;
        const auto from_before = [&](std::size_t k) { return connection(k).from == before && connection(k).tl < 0; };
        const auto to_edge = [&](std::size_t k) { return connection(k).to == edge; };
        const auto has_via = [&](std::size_t k) { return connection(k).via >= 0; };
        if (before == edge || !std::all_of(in_[at(edge)].begin(), in_[at(edge)].end(), from_before)) return;
        if (!std::all_of(out_[at(before)].begin(), out_[at(before)].end(), to_edge)) return;
        if (!std::all_of(out_[at(edge)].begin(), out_[at(edge)].end(), has_via)) return;
        take_over(before, edge);
    }

    // The lanes of the way between, in order.
    std::vector<const SumoLane*> way(const SumoConnection& c) const {
        constexpr std::size_t kMost = 16;
        std::vector<const SumoLane*> lanes;
        int via = c.via;
        int lane = c.via_lane;
        while (via >= 0 && lanes.size() < kMost) {
            lanes.push_back(&net_.edges[at(via)].lanes[at(lane)]);
            const auto next = onward_.find({via, lane});
            via = next == onward_.end() ? -1 : connection(next->second).via;
            lane = next == onward_.end() ? 0 : connection(next->second).via_lane;
        }
        return lanes;
    }

    void take_over(int before, int edge) {
        SumoEdge& longer = net_.edges[at(before)];
        const SumoEdge own = net_.edges[at(edge)];
        std::vector<bool> grown(longer.lanes.size(), false);
        double more_m = 0.0;
        std::vector<SumoConnection> onward;
        take_over_loops(before, edge);
        for (const std::size_t in : in_[at(edge)]) {
            const SumoConnection c = connection(in);
            SumoLane& lane = longer.lanes[at(c.from_lane)];
            double way_m = own.lanes[at(c.to_lane)].length_m;
            std::vector<const SumoLane*> parts = way(c);
            for (const SumoLane* const part : parts) way_m += part->length_m;
            parts.push_back(&own.lanes[at(c.to_lane)]);
            add_end(lane, own, c.to_lane, !grown[at(c.from_lane)]);
            if (!grown[at(c.from_lane)]) {
                for (const SumoLane* const part : parts) sumo_append(lane.shape, part->shape);
                more_m = std::max(more_m, way_m);
            }
            grown[at(c.from_lane)] = true;
            for (const std::size_t out : out_[at(edge)]) {
                if (connection(out).from_lane != c.to_lane) continue;
                onward.push_back(connection(out));
                onward.back().from = before;
                onward.back().from_lane = c.from_lane;
            }
        }
        for (SumoLane& lane : longer.lanes) lane.length_m += more_m;
        for (const std::size_t gone : in_[at(edge)]) net_.connections[gone].from = -1;
        for (const std::size_t gone : out_[at(edge)]) net_.connections[gone].from = -1;
        replace(before, edge, std::move(onward));
    }

    // That a lane ends where another one of a shorter edge does; `anew`: and nowhere else.
    static void add_end(SumoLane& lane, const SumoEdge& shorter, int index, bool anew) {
        if (anew) lane.ends.clear();
        const SumoLane& last = shorter.lanes[at(index)];
        std::vector<std::string> ends = last.ends;
        if (ends.empty()) ends.push_back(fmt::format("{}_{}", shorter.id, index));
        lane.ends.insert(lane.ends.end(), ends.begin(), ends.end());
    }

    // A loop lies as far before the end as it did.
    void take_over_loops(int before, int edge) {
        for (SumoLoop& loop : net_.loops) {
            if (loop.edge != edge) continue;
            const auto leads_there = [&](std::size_t k) { return connection(k).to_lane == loop.lane; };
            const auto in = std::find_if(in_[at(edge)].begin(), in_[at(edge)].end(), leads_there);
            if (in == in_[at(edge)].end()) continue;  // nobody comes there
            const SumoConnection& c = connection(*in);
            loop.edge = before;
            loop.lane = c.from_lane;
            loop.position_m += net_.edges[at(before)].lanes[at(c.from_lane)].length_m;
            for (const SumoLane* const part : way(c)) loop.position_m += part->length_m;
        }
    }

    void replace(int before, int edge, std::vector<SumoConnection> onward) {
        const auto is_gone = [&](std::size_t k) { return connection(k).from < 0; };
        out_[at(before)].clear();
        out_[at(edge)].clear();
        in_[at(edge)].clear();
        for (SumoConnection& c : onward) {
            std::erase_if(in_[at(c.to)], is_gone);
            out_[at(before)].push_back(net_.connections.size());
            in_[at(c.to)].push_back(net_.connections.size());
            net_.connections.push_back(std::move(c));
        }
        net_.edges[at(edge)].joined_to = before;
        for (SumoLane& lane : net_.edges[at(edge)].lanes) lane.cars = false;
    }

    SumoNet& net_;
    std::vector<std::vector<std::size_t>> out_;  // [edge] connections to other edges
    std::vector<std::vector<std::size_t>> in_;
    std::map<std::pair<int, int>, std::size_t> onward_;  // by internal edge and lane
};

}  // namespace

void join_short_edges(SumoNet& net) { Joiner(net).join(); }

}  // namespace stopline
