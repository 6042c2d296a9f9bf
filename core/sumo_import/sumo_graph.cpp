#include "sumo_import/sumo_graph.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "base/containers/index.h"
#include "base/input_error.h"
#include "base/simd/arithmetic.h"
#include "network/conflicts.h"
#include "sumo_import/controllers/sumo_controller.h"
#include "sumo_import/sumo_right_of_way.h"
#include "sumo_import/sumo_short_edges.h"

namespace stopline {

namespace {

constexpr double kMinConnection_m = 1.0;

class Builder {
public:
    Builder(SumoNet net, double clearance_m) : clearance_m_(clearance_m) { network_.net = std::move(net); }

    SumoNetwork build() {
        net().check_lights();
        set_sumo_controllers(network_.net);
        network_.lights.push_back({});
        merge_short_edges(network_.net);
        add_edges();
        index_chains();
        for (const SumoConnection& c : net().connections) {
            if (!edge(c.from).internal && !edge(c.to).internal) connections_.push_back({&c});
        }
        for (BuiltConnection& connection : connections_) trace_chain(connection);
        assign_turns();
        for (BuiltConnection& connection : connections_) add_connection(connection);
        assign_shared_stretches();
        name_internal_lanes();
        for (int lane = 0; lane < first_connection_; ++lane) finish_lane(lane);
        assign_signal_groups();
        find_sumo_conflicts(network_, connections_, clearance_m_);
        place_sumo_detectors(network_, connections_);
        limit_entry_speeds();
        drop_loops_off_car_lanes();
        network_.graph.signal_groups = static_cast<int>(network_.lights.size());
        return std::move(network_);
    }

private:
    const SumoNet& net() const { return network_.net; }
    const SumoEdge& edge(int index) const { return network_.net.edges[at(index)]; }
    std::vector<Lane>& lanes() { return network_.graph.lanes; }

    void drop_loops_off_car_lanes() {
        std::erase_if(network_.net.loops, [&](const SumoLoop& loop) {
            if (network_.lane_of[at(loop.edge)][at(loop.lane)] >= 0) return false;
            network_.net.warnings.note(
                loop.where, "the detector is ignored: it lies inside a junction or on a lane closed to cars");
            return true;
        });
    }

    // Adds the lanes that are open to cars, edge by edge and from left to right. Edges inside junctions are skipped.
    void add_edges() {
        for (const SumoEdge& edge : net().edges) {
            std::vector<int>& numbers = network_.lane_of.emplace_back(edge.lanes.size(), -1);
            network_.approach_of.push_back(-1);
            const auto first_open =
                std::find_if(edge.lanes.begin(), edge.lanes.end(), [](auto& lane) { return lane.allows_cars; });
            if (edge.internal || first_open == edge.lanes.end()) continue;
            network_.approach_of.back() = static_cast<int>(network_.graph.approaches.size());
            Approach approach{edge.id, {}, 0.0, 0.0};
            for (auto k = static_cast<int>(edge.lanes.size()) - 1; k >= 0; --k) {
                const SumoLane& from = edge.lanes[at(k)];
                if (!from.allows_cars) continue;
                Lane lane;
                lane.name = fmt::format("{}_{}", edge.id, k);
                lane.length_m = lane.stop_line_m = first_open->length_m;
                lane.limit_mps = from.speed_mps;
                lane.shape = from.shape;
                lane.shape_scale = length_m(lane.shape) / lane.length_m;
                lane.approach = network_.approach_of.back();
                const double first_m = from.merged_lanes.size() > 1 ? from.merged_lanes.front().second : 0.0;
                lane.parts = parts_of(from.merged_lanes, first_m, lane.stop_line_m);
                lane.left = approach.lanes.empty() ? -1 : approach.lanes.back();
                numbers[at(k)] = static_cast<int>(lanes().size());
                if (lane.left >= 0) lanes()[at(lane.left)].right = numbers[at(k)];
                approach.lanes.push_back(numbers[at(k)]);
                lanes().push_back(std::move(lane));
            }
            network_.graph.approaches.push_back(std::move(approach));
        }
        first_connection_ = static_cast<int>(lanes().size());
    }

    // Makes the parts of one lane of the graph from consecutive lanes of the SUMO file, each given by name and length.
    // The first `fixed_m` metres keep their length. The rest is stretched evenly, so that the whole lane is `length_m`
    // long.
    static std::vector<LanePart> parts_of(const std::vector<std::pair<std::string, double>>& lanes, double fixed_m,
                                          double length_m) {
        std::vector<LanePart> parts;
        double sum_m = 0.0;
        for (const auto& [name, part_m] : lanes) parts.push_back({name, sum_m += part_m, part_m});
        const double stretch = sum_m > fixed_m ? (length_m - fixed_m) / (sum_m - fixed_m) : 1.0;
        for (LanePart& part : parts) part.end_m = fixed_m + stretch * (part.end_m - fixed_m);
        return parts;
    }

    void index_chains() {
        for (const SumoConnection& c : net().connections) {
            if (edge(c.from).internal) next_in_chain_[{c.from, c.from_lane}] = &c;
        }
    }

    // Sets shape, speed limit, junction and link number of a connection from its internal lanes, which form a chain:
    // the attribute `via` of the connection names the first internal lane, and each internal lane leads to the next.
    void trace_chain(BuiltConnection& connection) const {
        constexpr int kMaxLanes = 16;
        const SumoConnection& c = *connection.source;
        connection.speed_mps =
            std::min(edge(c.from).lanes[at(c.from_lane)].speed_mps, edge(c.to).lanes[at(c.to_lane)].speed_mps);
        int via = c.via;
        int lane = c.via_lane;
        for (int k = 0; via >= 0; ++k) {
            const SumoLane& inner = edge(via).lanes[at(lane)];
            connection.speed_mps = std::min(connection.speed_mps, inner.speed_mps);
            sumo_append(connection.shape, inner.shape);
            connection.internal_lanes.emplace_back(fmt::format("{}_{}", edge(via).id, lane), inner.length_m);
            const auto link = net().link_of.find(connection.internal_lanes.back().first);
            if (link != net().link_of.end()) std::tie(connection.junction, connection.link) = link->second;
            const auto next = next_in_chain_.find({via, lane});
            if (next == next_in_chain_.end() || next->second->to != c.to || next->second->to_lane != c.to_lane ||
                k == kMaxLanes) {
                throw InputError(fmt::format("{}: the chain of 'via' lanes does not lead to lane {} of edge '{}'",
                                             c.where, c.to_lane, edge(c.to).id));
            }
            via = next->second->via;
            lane = next->second->via_lane;
        }
        const Polyline& before = edge(c.from).lanes[at(c.from_lane)].shape;
        if (connection.shape.empty()) connection.shape = {before.back(), edge(c.to).lanes[at(c.to_lane)].shape.front()};
        if (connection.shape.size() < 2 || length_m(connection.shape) < kMinConnection_m) {
            const Pose end = pose_at(before, length_m(before));
            connection.shape = {
                end.point,
                {end.point.x_m + kMinConnection_m * end.cosine, end.point.y_m + kMinConnection_m * end.sine}};
        }
        if (connection.shape.size() > kSumoPointsMax) {
            throw InputError(
                fmt::format("{}: the path from edge '{}' to edge '{}' has {} points; at most {} are allowed", c.where,
                            edge(c.from).id, edge(c.to).id, connection.shape.size(), kSumoPointsMax));
        }
        if (const double length = length_m(connection.shape); length > kSumoConnectionLengthMax_m) {
            throw InputError(
                fmt::format("{}: the path from edge '{}' to edge '{}' is {:.0f} m long; at most {:.0f} m "
                            "are allowed in a junction",
                            c.where, edge(c.from).id, edge(c.to).id, length, kSumoConnectionLengthMax_m));
        }
    }

    // Gives each edge to which a given edge leads a Turn value of its own: straight, right or left according to SUMO's
    // attribute `dir`. If `dir` has another direction, or if another of these edges already has the value, assigns the
    // next unused value.
    void assign_turns() {
        std::map<std::pair<int, int>, Turn> turns;      // [from edge, to edge]
        std::map<int, std::vector<bool>> used_by_edge;  // [from edge][turn] true: a successor has this turn
        const auto assign = [&](const SumoConnection& c, std::size_t preferred) {
            const std::pair key{c.from, c.to};
            if (turns.contains(key)) return;
            std::vector<bool>& used = used_by_edge.try_emplace(c.from, at(kMaxTurns), false).first->second;
            std::size_t turn = preferred;
            constexpr std::size_t kFirstExtraTurn = 4;
            if (turn == 0 || used[turn]) turn = kFirstExtraTurn;
            while (turn < used.size() && used[turn]) ++turn;
            if (turn == used.size()) {
                throw InputError(fmt::format("{}: edge '{}' leads to more than {} other edges", c.where,
                                             edge(c.from).id, kMaxTurns - 1));
            }
            used[turn] = true;
            turns[key] = static_cast<Turn>(turn);
        };
        const auto usual_turn = [](char dir) { return dir == 's' ? 1 : dir == 'r' ? 2 : dir == 'l' ? 3 : 0; };
        for (const BuiltConnection& connection : connections_) {
            if (const int turn = usual_turn(connection.source->dir); turn > 0) assign(*connection.source, at(turn));
        }
        for (const BuiltConnection& connection : connections_) assign(*connection.source, 0);
        for (BuiltConnection& connection : connections_) {
            connection.turn = turns.at({connection.source->from, connection.source->to});
        }
    }

    void add_connection(BuiltConnection& connection) {
        const SumoConnection& c = *connection.source;
        Lane lane;
        lane.origin = network_.lane_of[at(c.from)][at(c.from_lane)];
        lane.next = {network_.lane_of[at(c.to)][at(c.to_lane)]};
        lane.name = c.via >= 0 ? fmt::format("{}_{}", edge(c.via).id, c.via_lane)
                               : fmt::format("{}_to_{}_{}", lanes()[at(lane.origin)].name, edge(c.to).id, c.to_lane);
        lane.shape = connection.shape;
        lane.length_m = length_m(lane.shape);
        lane.limit_mps = connection.speed_mps;
        lane.turn = connection.turn;
        lane.keep_clear = c.keep_clear;
        connection.lane = static_cast<int>(lanes().size());
        lanes()[at(lane.origin)].next.push_back(connection.lane);
        network_.graph.routes.push_back({lane.name, {lane.origin, connection.lane, lane.next[0]}});
        lanes().push_back(std::move(lane));
    }

    // Connections that begin on the same lane share a first stretch. Beyond it, vehicles on different connections are
    // clear of each other. This function makes the stretch a part of the lane. If one of the connections is too short,
    // only a part of the stretch goes to the lane. The rest stays at the start of the connections, up to diverge_end_m.
    void assign_shared_stretches() {
        for (int index = 0; index < first_connection_; ++index) {
            const std::vector<int> next = lanes()[at(index)].next;
            widen_u_turns(next);
            const std::vector<std::vector<double>> diverges_m = diverge_distances_m(next);
            double diverge_m = 0.0;
            double first_diverge_m = 1e9;
            for (const auto& row : diverges_m) {
                for (const double pair_m : row) {
                    if (pair_m < 0.0) continue;
                    diverge_m = std::max(diverge_m, pair_m);
                    first_diverge_m = std::min(first_diverge_m, pair_m);
                }
            }
            double shared_m = diverge_m;
            for (const int k : next) shared_m = std::min(shared_m, lanes()[at(k)].length_m - kMinConnection_m);
            shared_m = std::max(shared_m, 0.0);
            lanes()[at(index)].length_m += shared_m;
            for (std::size_t k = 0; k < next.size(); ++k) {
                Lane& connection = lanes()[at(next[k])];
                connection.length_m -= shared_m;
                connection.shape_start_m = shared_m;
                connection.diverge_end_m = diverge_m - shared_m;
                if (first_diverge_m >= diverge_m) continue;
                for (const double pair_m : diverges_m[k])
                    connection.diverge_ends_m.push_back((pair_m < 0.0 ? diverge_m : pair_m) - shared_m);
            }
        }
    }

    // Returns for each pair of connections in `next`, [index][index], the distance from their start to the point beyond
    // which the two have diverged. Connections to the same lane do not diverge: the result is -1 for such a pair, and
    // for a connection with itself.
    std::vector<std::vector<double>> diverge_distances_m(const std::vector<int>& next) {
        std::vector<std::vector<double>> distances_m(next.size(), std::vector<double>(next.size(), -1.0));
        for (std::size_t first = 0; first < next.size(); ++first) {
            for (std::size_t second = 0; second < first; ++second) {
                const Lane& a = lanes()[at(next[first])];
                const Lane& b = lanes()[at(next[second])];
                if (a.next == b.next) continue;
                distances_m[first][second] = distances_m[second][first] = std::max(
                    shared_stretch_m(a.shape, b.shape, clearance_m_), shared_stretch_m(b.shape, a.shape, clearance_m_));
            }
        }
        return distances_m;
    }

    // Sets Lane::parts of all connections. A connection without internal lanes gets a single part with the name of the
    // exit lane and with LanePart::length_m = 0, because the file has no lane for this connection.
    void name_internal_lanes() {
        for (const BuiltConnection& connection : connections_) {
            Lane& lane = lanes()[at(connection.lane)];
            const double length_m = lane.shape_start_m + lane.length_m;
            lane.parts = parts_of(connection.internal_lanes, 0.0, length_m);
            if (lane.parts.empty()) lane.parts.push_back({lanes()[at(lane.next[0])].name, length_m, 0.0});
        }
    }

    // Returns the distance from the start of the connections in `next` to the point beyond which all of them except
    // U-turns have diverged. Connections to the same lane are not compared with each other.
    double last_diverge_m(const std::vector<int>& next) {
        double last_m = 0.0;
        for (const int first : next) {
            for (const int second : next) {
                const Lane& a = lanes()[at(first)];
                const Lane& b = lanes()[at(second)];
                if (first == second || a.next == b.next || is_u_turn(a) || is_u_turn(b)) continue;
                last_m = std::max(last_m, shared_stretch_m(a.shape, b.shape, clearance_m_));
            }
        }
        return last_m;
    }

    // Extends a U-turn into the junction (up to a limit) if it is shorter than the first stretch that the other
    // connections of its lane share. netconvert draws a U-turn directly at the end of its lane.
    void widen_u_turns(const std::vector<int>& next) {
        constexpr double kMaxExtension_m = 4.0;
        const double diverge_m = last_diverge_m(next) + kMinConnection_m;
        for (const int index : next) {
            Lane& connection = lanes()[at(index)];
            if (connection.length_m >= diverge_m || !is_u_turn(connection)) continue;
            const double ahead_m = std::min(0.5 * (diverge_m - connection.length_m), kMaxExtension_m);
            const Pose from = end_of(lanes()[at(connection.origin)]);
            Polyline wide{connection.shape.front()};
            for (const Point& p : connection.shape) {
                wide.push_back({p.x_m + ahead_m * from.cosine, p.y_m + ahead_m * from.sine});
            }
            wide.push_back(connection.shape.back());
            connection.shape = std::move(wide);
            connection.length_m = length_m(connection.shape);
        }
    }

    static Pose end_of(const Lane& lane) { return pose_at(lane.shape, length_m(lane.shape)); }

    bool is_u_turn(const Lane& connection) {
        const Pose from = end_of(lanes()[at(connection.origin)]);
        const Pose to = pose_at(lanes()[at(connection.next[0])].shape, 0.0);
        return from.cosine * to.cosine + from.sine * to.sine < -0.9;
    }

    // Adds the lane to LaneGraph::links, and adds a route that consists of this lane only. If any lane of the approach
    // leads to a connection, gives this lane a stop line, at first of signal group 0, which is always green.
    void finish_lane(int lane) {
        network_.graph.routes.push_back({lanes()[at(lane)].name, {lane}});
        network_.graph.links.push_back(lane);
        const Approach& approach = network_.graph.approaches[at(lanes()[at(lane)].approach)];
        const bool continues = std::any_of(approach.lanes.begin(), approach.lanes.end(),
                                           [&](int k) { return !lanes()[at(k)].next.empty(); });
        if (continues) lanes()[at(lane)].signal_group = 0;
    }

    // Makes the signal groups. Links of a signal that have the same lights in all phases share one group. The stop line
    // of a lane gets the group of the first connection of this lane. If the connections of the lane have different
    // groups, each connection also stores its own group in Lane::movement_signal_group.
    void assign_signal_groups() {
        std::map<std::pair<int, std::string>, int> groups;
        const auto group_of = [&](const SumoConnection& c) {
            if (c.tl < 0) return 0;
            std::string letters;
            for (const SumoPhase& phase : net().signals[at(c.tl)].phases) {
                const char letter = phase.state[at(c.tl_link)];
                letters += sumo_is_green(letter) ? 'G' : letter == 'y' || letter == 'Y' ? 'y' : 'r';
            }
            const auto [known, added] = groups.try_emplace({c.tl, letters}, static_cast<int>(network_.lights.size()));
            if (added) network_.lights.push_back({c.tl, c.tl_link});
            return known->second;
        };
        for (const BuiltConnection& connection : connections_)
            lanes()[at(connection.lane)].movement_signal_group = group_of(*connection.source);
        for (int index = 0; index < first_connection_; ++index) {
            const std::vector<int>& next = lanes()[at(index)].next;
            if (next.empty()) continue;
            const int first = lanes()[at(next[0])].movement_signal_group;
            const auto same = [&](int connection) { return lanes()[at(connection)].movement_signal_group == first; };
            lanes()[at(index)].signal_group = first;
            if (!std::all_of(next.begin(), next.end(), same)) continue;
            for (const int connection : next) lanes()[at(connection)].movement_signal_group = -1;
        }
    }

    // Lowers the speed limit of a connection, but not below kMinEntrySpeed_mps, if its exit lane is too short to brake
    // from the limit to the safe speed at the end of this lane. The safe speed is 0 before a signal or a conflict area.
    // Elsewhere the safe speed depends on the next lane, so a chain of short lanes needs several rounds.
    void limit_entry_speeds() {
        constexpr double kBraking_mps2 = 3.0;
        constexpr double kMargin_m = 2.0;
        constexpr double kMinEntrySpeed_mps = 3.0;
        constexpr int kRounds = 8;
        std::vector<double> entry_mps(lanes().size(), 1e9);
        for (int round = 0; round < kRounds; ++round) {
            for (std::size_t index = lanes().size(); index-- > 0;) {
                const Lane& lane = lanes()[index];
                double end_mps = lane.origin >= 0 ? entry_mps[at(lane.next[0])] : 1e9;
                if (lane.origin < 0) {
                    for (const int connection : lane.next) {
                        const bool stops = lane.signal_group > 0 || lanes()[at(connection)].movement_signal_group > 0 ||
                                           !network_.graph.conflicts[at(connection)].empty();
                        end_mps = std::min(
                            end_mps,
                            stops ? 0.0 : std::min(entry_mps[at(connection)], lanes()[at(connection)].limit_mps));
                    }
                }
                const double braking_m = lane.origin >= 0 ? 0.0 : std::max(lane.stop_line_m - kMargin_m, 0.0);
                const double safe_mps = std::sqrt(square(end_mps) + 2.0 * kBraking_mps2 * braking_m);
                entry_mps[index] = std::max(safe_mps, kMinEntrySpeed_mps);
            }
        }
        for (std::size_t index = at(first_connection_); index < lanes().size(); ++index) {
            lanes()[index].limit_mps = std::min(lanes()[index].limit_mps, entry_mps[index]);
        }
    }

    SumoNetwork network_;
    double clearance_m_;
    int first_connection_ = 0;
    std::vector<BuiltConnection> connections_;
    std::map<std::pair<int, int>, const SumoConnection*> next_in_chain_;  // [internal edge, lane] connection from there
};

}  // namespace

bool sumo_is_green(char letter) {
    return letter == 'G' || letter == 'g' || letter == 's' || letter == 'o' || letter == 'O';
}

namespace {

// Returns the longest green time of any link of the signal, s. Links that are always green are ignored. A green can
// span several phases and continue beyond the end of the cycle.
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
    constexpr double kDefault_s = 90.0;
    double longest_s = 0.0;
    for (const SumoSignal& signal : net.signals) longest_s = std::max(longest_s, signal.cycle_s());
    return longest_s > 0.0 ? longest_s : kDefault_s;
}

double SumoNetwork::longest_green_s() const {
    constexpr double kDefault_s = 40.0;
    double longest_s = 0.0;
    for (const SumoSignal& signal : net.signals) longest_s = std::max(longest_s, longest_green_of(signal));
    return longest_s > 0.0 ? longest_s : kDefault_s;
}

SumoNetwork make_sumo_network(SumoNet net, double clearance_m) { return Builder(std::move(net), clearance_m).build(); }

}  // namespace stopline
