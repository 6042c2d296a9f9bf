#include "network/sumo_graph.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "base/arithmetic.h"
#include "base/input_error.h"
#include "network/conflicts.h"
#include "network/sumo_right_of_way.h"
#include "network/sumo_short_edges.h"

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

constexpr double kShortest_m = 1.0;  // of a lane inside an intersection

class Builder {
public:
    Builder(SumoNet net, double clearance_m) : clearance_m_(clearance_m) { made_.net = std::move(net); }

    SumoNetwork build() {
        net().check_lights();
        made_.lights.push_back({});
        join_short_edges(made_.net);
        add_edges();
        index_chains();
        for (const SumoConnection& c : net().connections) {
            if (!edge(c.from).internal && !edge(c.to).internal) ways_.push_back({&c, {}, 0.0, -1, -1});
        }
        for (SumoWay& way : ways_) follow(way);
        number_turns();
        for (SumoWay& way : ways_) add_way(way);
        share_stretches();
        for (int lane = 0; lane < inside_from_; ++lane) add_end(lane);
        add_lights();
        find_sumo_conflicts(made_, ways_, clearance_m_);
        slow_before_short_lanes();
        keep_loops_of_cars();
        made_.graph.signal_groups = static_cast<int>(made_.lights.size());
        return std::move(made_);
    }

private:
    const SumoNet& net() const { return made_.net; }
    const SumoEdge& edge(int index) const { return made_.net.edges[at(index)]; }
    std::vector<Lane>& lanes() { return made_.graph.lanes; }

    void keep_loops_of_cars() {
        std::erase_if(made_.net.loops, [&](const SumoLoop& loop) {
            if (made_.lane_of[at(loop.edge)][at(loop.lane)] >= 0) return false;
            made_.net.warnings.note(loop.where,
                                    "a detector inside a junction, or on a lane where cars do not drive, is left out");
            return true;
        });
    }

    // The lanes of an edge, from the left.
    void add_edges() {
        for (const SumoEdge& edge : net().edges) {
            std::vector<int>& numbers = made_.lane_of.emplace_back(edge.lanes.size(), -1);
            made_.approach_of.push_back(-1);
            const auto cars = std::find_if(edge.lanes.begin(), edge.lanes.end(), [](auto& lane) { return lane.cars; });
            if (edge.internal || cars == edge.lanes.end()) continue;
            made_.approach_of.back() = static_cast<int>(made_.graph.approaches.size());
            Approach approach{edge.id, {}, 0.0, 0.0};
            for (auto k = static_cast<int>(edge.lanes.size()) - 1; k >= 0; --k) {
                const SumoLane& from = edge.lanes[at(k)];
                if (!from.cars) continue;
                Lane lane;
                lane.name = fmt::format("{}_{}", edge.id, k);
                lane.length_m = lane.stop_line_m = cars->length_m;
                lane.limit_mps = from.speed_mps;
                lane.shape = from.shape;
                lane.shape_scale = length_m(lane.shape) / lane.length_m;
                lane.approach = made_.approach_of.back();
                lane.left = approach.lanes.empty() ? -1 : approach.lanes.back();
                numbers[at(k)] = static_cast<int>(lanes().size());
                if (lane.left >= 0) lanes()[at(lane.left)].right = numbers[at(k)];
                approach.lanes.push_back(numbers[at(k)]);
                lanes().push_back(std::move(lane));
            }
            made_.graph.approaches.push_back(std::move(approach));
        }
        inside_from_ = static_cast<int>(lanes().size());
    }

    void index_chains() {
        for (const SumoConnection& c : net().connections) {
            if (edge(c.from).internal) onward_[{c.from, c.from_lane}] = &c;
        }
    }

    // Joins the lanes of a chain of `via` and finds its link.
    void follow(SumoWay& way) const {
        constexpr int kMost = 16;
        const SumoConnection& c = *way.connection;
        way.speed_mps =
            std::min(edge(c.from).lanes[at(c.from_lane)].speed_mps, edge(c.to).lanes[at(c.to_lane)].speed_mps);
        int via = c.via;
        int lane = c.via_lane;
        for (int k = 0; via >= 0; ++k) {
            const SumoLane& inner = edge(via).lanes[at(lane)];
            way.speed_mps = std::min(way.speed_mps, inner.speed_mps);
            sumo_append(way.shape, inner.shape);
            const auto link = net().link_of.find(fmt::format("{}_{}", edge(via).id, lane));
            if (link != net().link_of.end()) std::tie(way.junction, way.link) = link->second;
            const auto next = onward_.find({via, lane});
            if (next == onward_.end() || next->second->to != c.to || next->second->to_lane != c.to_lane || k == kMost) {
                throw InputError(fmt::format("{}: the chain of 'via' does not lead to lane {} of edge '{}'", c.where,
                                             c.to_lane, edge(c.to).id));
            }
            via = next->second->via;
            lane = next->second->via_lane;
        }
        const Polyline& before = edge(c.from).lanes[at(c.from_lane)].shape;
        if (way.shape.empty()) way.shape = {before.back(), edge(c.to).lanes[at(c.to_lane)].shape.front()};
        if (way.shape.size() < 2 || length_m(way.shape) < kShortest_m) {
            const Pose end = place_at(before, length_m(before));
            way.shape = {end.point, {end.point.x_m + kShortest_m * end.cosine, end.point.y_m + kShortest_m * end.sine}};
        }
    }

    // Every edge to which one can go on has a turn of its own.
    void number_turns() {
        std::map<std::pair<int, int>, Turn> turns;  // from and to edge
        std::map<int, std::vector<bool>> taken;     // by from edge
        const auto give = [&](const SumoConnection& c, std::size_t wanted) {
            const std::pair key{c.from, c.to};
            if (turns.contains(key)) return;
            std::vector<bool>& used = taken.try_emplace(c.from, at(kMostTurns), false).first->second;
            std::size_t turn = wanted;
            constexpr std::size_t kFirstMore = 4;
            if (turn == 0 || used[turn]) turn = kFirstMore;
            while (turn < used.size() && used[turn]) ++turn;
            if (turn == used.size()) {
                throw InputError(fmt::format("{}: edge '{}' leads to more than {} other edges", c.where,
                                             edge(c.from).id, kMostTurns - 1));
            }
            used[turn] = true;
            turns[key] = static_cast<Turn>(turn);
        };
        const auto plain = [](char dir) { return dir == 's' ? 1 : dir == 'r' ? 2 : dir == 'l' ? 3 : 0; };
        for (const SumoWay& way : ways_) {
            if (const int turn = plain(way.connection->dir); turn > 0) give(*way.connection, at(turn));
        }
        for (const SumoWay& way : ways_) give(*way.connection, 0);
        for (SumoWay& way : ways_) way.turn = turns.at({way.connection->from, way.connection->to});
    }

    void add_way(SumoWay& way) {
        const SumoConnection& c = *way.connection;
        Lane lane;
        lane.origin = made_.lane_of[at(c.from)][at(c.from_lane)];
        lane.next = {made_.lane_of[at(c.to)][at(c.to_lane)]};
        lane.name = c.via >= 0 ? fmt::format("{}_{}", edge(c.via).id, c.via_lane)
                               : fmt::format("{}_to_{}_{}", lanes()[at(lane.origin)].name, edge(c.to).id, c.to_lane);
        lane.shape = way.shape;
        lane.length_m = length_m(lane.shape);
        lane.limit_mps = way.speed_mps;
        lane.turn = way.turn;
        lane.keeps_clear = c.keep_clear;
        way.lane = static_cast<int>(lanes().size());
        lanes()[at(lane.origin)].next.push_back(way.lane);
        made_.graph.routes.push_back({lane.name, {lane.origin, way.lane, lane.next[0]}});
        lanes().push_back(std::move(lane));
    }

    // What the movements of a lane share belongs to it: beyond, their vehicles are clear of each other. Where a way is too short for that,
    // they are so further on.
    void share_stretches() {
        for (int index = 0; index < inside_from_; ++index) {
            const std::vector<int> next = lanes()[at(index)].next;
            widen_turnarounds(next);
            const double parted_m = parting_m(next, [](const Lane&) { return true; });
            double shared_m = parted_m;
            for (const int one : next) shared_m = std::min(shared_m, lanes()[at(one)].length_m - kShortest_m);
            shared_m = std::max(shared_m, 0.0);
            lanes()[at(index)].length_m += shared_m;
            for (const int one : next) {
                Lane& way = lanes()[at(one)];
                way.length_m -= shared_m;
                way.shape_start_m = shared_m;
                way.clear_m = parted_m - shared_m;
            }
        }
    }

    // Where the last two of some lanes part whose turns are counted.
    template <class Counts>
    double parting_m(const std::vector<int>& next, const Counts& counts) {
        double parted_m = 0.0;
        for (const int one : next) {
            for (const int two : next) {
                const Lane& a = lanes()[at(one)];
                const Lane& b = lanes()[at(two)];
                if (one == two || a.next == b.next || !counts(a) || !counts(b)) continue;
                parted_m = std::max(parted_m, shared_stretch_m(a.shape, b.shape, clearance_m_));
            }
        }
        return parted_m;
    }

    // Who turns round drives on to where the others part, if that is near, and not on the spot, as the shapes of netconvert do.
    void widen_turnarounds(const std::vector<int>& next) {
        constexpr double kFurthest_m = 4.0;
        const double parted_m = parting_m(next, [&](const Lane& lane) { return !turns_round(lane); }) + kShortest_m;
        for (const int one : next) {
            Lane& way = lanes()[at(one)];
            if (way.length_m >= parted_m || !turns_round(way)) continue;
            const double ahead_m = std::min(0.5 * (parted_m - way.length_m), kFurthest_m);
            const Pose from = end_of(lanes()[at(way.origin)]);
            Polyline wide{way.shape.front()};
            for (const Point& p : way.shape) {
                wide.push_back({p.x_m + ahead_m * from.cosine, p.y_m + ahead_m * from.sine});
            }
            wide.push_back(way.shape.back());
            way.shape = std::move(wide);
            way.length_m = length_m(way.shape);
        }
    }

    static Pose end_of(const Lane& lane) { return place_at(lane.shape, length_m(lane.shape)); }

    bool turns_round(const Lane& way) {
        const Pose from = end_of(lanes()[at(way.origin)]);
        const Pose to = place_at(lanes()[at(way.next[0])].shape, 0.0);
        return from.cosine * to.cosine + from.sine * to.sine < -0.9;
    }

    // Vehicles go on from every lane, or their routes end there.
    void add_end(int lane) {
        made_.graph.routes.push_back({lanes()[at(lane)].name, {lane}});
        made_.graph.links.push_back(lane);
        const Approach& approach = made_.graph.approaches[at(lanes()[at(lane)].approach)];
        const bool leads_on = std::any_of(approach.lanes.begin(), approach.lanes.end(),
                                          [&](int each) { return !lanes()[at(each)].next.empty(); });
        if (leads_on) lanes()[at(lane)].signal_group = 0;
    }

    // A signal group for each sequence of letters of a programme.
    void add_lights() {
        std::map<std::pair<int, std::string>, int> groups;
        const auto group_of = [&](const SumoConnection& c) {
            if (c.tl < 0) return 0;
            std::string letters;
            for (const SumoPhase& phase : net().signals[at(c.tl)].phases) {
                const char letter = phase.state[at(c.tl_link)];
                letters += sumo_is_green(letter) ? 'G' : letter == 'y' || letter == 'Y' ? 'y' : 'r';
            }
            const auto [known, added] = groups.try_emplace({c.tl, letters}, static_cast<int>(made_.lights.size()));
            if (added) made_.lights.push_back({c.tl, c.tl_link});
            return known->second;
        };
        for (const SumoWay& way : ways_) lanes()[at(way.lane)].light = group_of(*way.connection);
        for (int index = 0; index < inside_from_; ++index) {
            const std::vector<int>& next = lanes()[at(index)].next;
            if (next.empty()) continue;
            const int first = lanes()[at(next[0])].light;
            const auto same = [&](int way) { return lanes()[at(way)].light == first; };
            lanes()[at(index)].signal_group = first;
            if (!std::all_of(next.begin(), next.end(), same)) continue;
            for (const int way : next) lanes()[at(way)].light = -1;
        }
    }

    // See the top of the header. A lane's speed at its start is limited by what it must have come down to at its end.
    void slow_before_short_lanes() {
        constexpr double kBraking_mps2 = 3.0;
        constexpr double kMargin_m = 2.0;
        constexpr double kSlowest_mps = 3.0;
        constexpr int kRounds = 8;
        std::vector<double> entry_mps(lanes().size(), 1e9);
        for (int round = 0; round < kRounds; ++round) {
            for (std::size_t index = lanes().size(); index-- > 0;) {
                const Lane& lane = lanes()[index];
                double end_mps = lane.origin >= 0 ? entry_mps[at(lane.next[0])] : 1e9;
                if (lane.origin < 0) {
                    for (const int way : lane.next) {
                        const bool stops = lane.signal_group > 0 || lanes()[at(way)].light > 0 ||
                                           !made_.graph.conflicts[at(way)].empty();
                        end_mps =
                            std::min(end_mps, stops ? 0.0 : std::min(entry_mps[at(way)], lanes()[at(way)].limit_mps));
                    }
                }
                const double room_m = lane.origin >= 0 ? 0.0 : std::max(lane.stop_line_m - kMargin_m, 0.0);
                const double most_mps = std::sqrt(square(end_mps) + 2.0 * kBraking_mps2 * room_m);
                entry_mps[index] = std::max(most_mps, kSlowest_mps);
            }
        }
        for (std::size_t index = at(inside_from_); index < lanes().size(); ++index) {
            lanes()[index].limit_mps = std::min(lanes()[index].limit_mps, entry_mps[index]);
        }
    }

    SumoNetwork made_;
    double clearance_m_;
    int inside_from_ = 0;
    std::vector<SumoWay> ways_;
    std::map<std::pair<int, int>, const SumoConnection*> onward_;  // by internal edge and lane
};

}  // namespace

bool sumo_is_green(char letter) {
    return letter == 'G' || letter == 'g' || letter == 's' || letter == 'o' || letter == 'O';
}

namespace {

// Of greens that end: phases of one link one after the other, the last and the first of the cycle too. 0: there is none.
double longest_green_of(const SumoSignal& signal) {
    double longest_s = 0.0;
    const std::size_t links = signal.phases.empty() ? 0 : signal.phases[0].state.size();
    for (std::size_t link = 0; link < links; ++link) {
        const auto is_green = [&](const SumoPhase& phase) {
            return link < phase.state.size() && sumo_is_green(phase.state[link]);
        };
        if (std::all_of(signal.phases.begin(), signal.phases.end(), is_green)) continue;
        double green_s = 0.0;
        for (std::size_t k = 0; k < 2 * signal.phases.size(); ++k) {
            const SumoPhase& phase = signal.phases[k % signal.phases.size()];
            green_s = is_green(phase) ? green_s + phase.duration_s : 0.0;
            longest_s = std::max(longest_s, green_s);
        }
    }
    return longest_s;
}

}  // namespace

double SumoNetwork::longest_cycle_s() const {
    constexpr double kUsual_s = 90.0;
    double longest_s = 0.0;
    for (const SumoSignal& signal : net.signals) longest_s = std::max(longest_s, signal.cycle_s());
    return longest_s > 0.0 ? longest_s : kUsual_s;
}

double SumoNetwork::longest_green_s() const {
    constexpr double kUsual_s = 40.0;
    double longest_s = 0.0;
    for (const SumoSignal& signal : net.signals) longest_s = std::max(longest_s, longest_green_of(signal));
    return longest_s > 0.0 ? longest_s : kUsual_s;
}

SumoNetwork make_sumo_network(SumoNet net, double clearance_m) { return Builder(std::move(net), clearance_m).build(); }

}  // namespace stopline
