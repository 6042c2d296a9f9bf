// The lane graph of streets that the user describes.
#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "base/containers/index.h"
#include "base/input_error.h"
#include "network/conflicts.h"
#include "network/generators/street_checks.h"
#include "network/generators/street_layout.h"

namespace stopline {

namespace {

using BySide = std::array<std::vector<int>, 4>;

struct Builder {
    const StreetSettings& s;
    StreetLayout layout{s};
    LaneGraph graph = {};
    std::vector<BySide> in = {};   // [intersection][side][k] approach lane k
    std::vector<BySide> out = {};  // [intersection][side][k] exit lane k

    int add(const Lane& lane) {
        graph.lanes.push_back(lane);
        return static_cast<int>(graph.lanes.size()) - 1;
    }

    // Returns the distance from the stop line at which the paths of all movements of the lane are `clearance_m` apart.
    double shared_m(int node, int side, int lane, double clearance_m) const {
        double longest_m = 0.0;
        const StreetLane& settings = layout.leg(node, side)->lanes[at(lane)];
        for (const Turn one : kTurns) {
            for (const Turn two : kTurns) {
                if (one >= two || !allows(settings, one) || !allows(settings, two)) continue;
                const Polyline a = layout.path(node, side, lane, one);
                const Polyline b = layout.path(node, side, lane, two);
                longest_m =
                    std::max({longest_m, shared_stretch_m(a, b, clearance_m), shared_stretch_m(b, a, clearance_m)});
            }
        }
        return longest_m;
    }

    // Returns the distance from the stop line at which the lane ends and its connections begin. A vehicle passes a
    // vehicle with another movement only beyond this point.
    double shared_m(int node, int side, int lane) const {
        constexpr double kMinConnection_m = 1.0;
        const double touching_m = shared_m(node, side, lane, s.clearance_m);
        if (s.passing_clearance_m <= s.clearance_m || touching_m == 0.0) return touching_m;
        double most_m = shared_m(node, side, lane, s.passing_clearance_m);
        for (const Turn turn : kTurns) {
            if (allows(layout.leg(node, side)->lanes[at(lane)], turn))
                most_m = std::min(most_m, length_m(layout.path(node, side, lane, turn)) - kMinConnection_m);
        }
        return std::max(touching_m, most_m);
    }

    int group_of(int node, int side, int lane) const {
        if (side % 2 == 1) return 3 * node + 2;
        const bool only_left = layout.leg(node, side)->lanes[at(lane)].movements == name_of(Turn::left);
        return 3 * node + (only_left && layout.node(node).programme.protected_left_s > 0.0 ? 1 : 0);
    }

    Lane approach_lane(int node, int side, int k) const {
        const StreetLeg& leg = *layout.leg(node, side);
        const double pocket_m = leg.lanes[at(k)].pocket_m;
        const double whole_m = layout.length_m(node, side);
        Lane lane;
        lane.name = fmt::format("{}_{}_in_{}", layout.node(node).name, kSides[at(side)], k);
        lane.limit_mps = leg.speed_limit_mps;
        lane.signal_group = group_of(node, side, k);
        lane.stop_line_m = pocket_m > 0.0 ? pocket_m : whole_m;
        lane.start_offset_m = whole_m - lane.stop_line_m;
        lane.length_m = lane.stop_line_m + shared_m(node, side, k);
        lane.shape = layout.approach(node, side, k);
        return lane;
    }

    // Adds the approach lanes of one leg.
    void add_approach(int node, int side) {
        const StreetLeg& leg = *layout.leg(node, side);
        const int from = layout.neighbour(node, side);
        const int first = StreetLayout::left_pockets(leg);
        // Number of lanes on which vehicles arrive, from the border or from another intersection.
        const int fed_lanes = from >= 0 ? layout.leg(from, opposite(side))->exits : StreetLayout::through_lanes(leg);
        Approach approach{
            fmt::format("{}_{}", layout.node(node).name, kSides[at(side)]), {}, leg.right_share, leg.left_share};
        for (int k = 0; k < static_cast<int>(leg.lanes.size()); ++k) {
            Lane lane = approach_lane(node, side, k);
            lane.approach = static_cast<int>(graph.approaches.size());
            lane.left = k > 0 ? approach.lanes.back() : -1;
            const int number = add(lane);
            if (k > 0) graph.lanes[at(approach.lanes.back())].right = number;
            approach.lanes.push_back(number);
            if (k >= first && k < first + fed_lanes) (from < 0 ? graph.entries : graph.links).push_back(number);
        }
        in[at(node)][at(side)] = approach.lanes;
        if (!approach.lanes.empty()) graph.approaches.push_back(std::move(approach));
    }

    void add_exits(int node, int side) {
        const StreetLeg& leg = *layout.leg(node, side);
        if (layout.neighbour(node, side) >= 0) return;
        for (int k = 0; k < leg.exits; ++k) {
            Lane lane;
            lane.name = fmt::format("{}_{}_out_{}", layout.node(node).name, kSides[at(side)], k);
            lane.limit_mps = leg.speed_limit_mps;
            lane.length_m = leg.exit_length_m;
            lane.shape = layout.exit(node, side, k);
            out[at(node)][at(side)].push_back(add(lane));
        }
    }

    // Records the approach lanes of the next intersection as exit lanes of this intersection.
    void connect_exits(int node, int side) {
        const int to = layout.neighbour(node, side);
        if (to < 0) return;
        const int first = StreetLayout::left_pockets(*layout.leg(to, opposite(side)));
        for (int k = 0; k < layout.leg(node, side)->exits; ++k) {
            out[at(node)][at(side)].push_back(in[at(to)][at(opposite(side))][at(first + k)]);
        }
    }

    Lane connection(int node, int side, int k, Turn turn) const {
        const StreetLeg& leg = *layout.leg(node, side);
        Lane lane;
        lane.name = fmt::format("{}_{}_{}_{}", layout.node(node).name, kSides[at(side)], k, name_of(turn));
        lane.shape = layout.path(node, side, k, turn);
        lane.origin = in[at(node)][at(side)][at(k)];
        const Lane& origin = graph.lanes[at(lane.origin)];
        lane.shape_start_m = origin.length_m - origin.stop_line_m;
        lane.length_m = length_m(lane.shape) - lane.shape_start_m;
        lane.limit_mps = turn == Turn::straight ? leg.speed_limit_mps : std::min(leg.speed_limit_mps, s.turn_speed_mps);
        lane.turn = turn;
        lane.next = {out[at(node)][at(exit_side(side, turn))][at(layout.exit_lane(node, side, k, turn))]};
        return lane;
    }

    void add_connections(int node, int side) {
        const StreetLeg& leg = *layout.leg(node, side);
        for (int k = 0; k < static_cast<int>(leg.lanes.size()); ++k) {
            for (const Turn turn : kTurns) {
                if (!allows(leg.lanes[at(k)], turn)) continue;
                const Lane lane = connection(node, side, k, turn);
                const int number = add(lane);
                graph.lanes[at(lane.origin)].next.push_back(number);
                graph.routes.push_back({lane.name, {lane.origin, number, lane.next[0]}});
            }
        }
    }

    template <class Act>
    void for_each_leg(const Act& act) {
        for (int node = 0; node < layout.nodes(); ++node) {
            for (int side = 0; side < 4; ++side) {
                if (layout.leg(node, side) != nullptr) act(node, side);
            }
        }
    }

    LaneGraph build() {
        in.resize(at(layout.nodes()));
        out.resize(at(layout.nodes()));
        graph.signal_groups = 3 * layout.nodes();
        for (int node = 0; node < layout.nodes(); ++node) {
            for (const int stage : {2 * node, 2 * node, 2 * node + 1}) graph.stage_of.push_back(stage);
        }
        for_each_leg([&](int node, int side) {
            add_approach(node, side);
            add_exits(node, side);
        });
        for_each_leg([&](int node, int side) { connect_exits(node, side); });
        std::vector<int> first_connection;  // [intersection] index of its first connection; last element: lane count
        for_each_leg([&](int node, int side) {
            if (static_cast<int>(first_connection.size()) == node) {
                first_connection.push_back(static_cast<int>(graph.lanes.size()));
            }
            add_connections(node, side);
        });
        first_connection.push_back(static_cast<int>(graph.lanes.size()));
        graph.conflicts.assign(graph.lanes.size(), {});
        for (std::size_t n = 0; n + 1 < first_connection.size(); ++n) {
            find_conflicts(graph, s.clearance_m, first_connection[n], first_connection[n + 1]);
        }
        return std::move(graph);
    }
};

}  // namespace

LaneGraph make_streets(const StreetSettings& streets) {
    const std::vector<StreetProblem> problems = street_problems(streets);
    if (!problems.empty()) {
        throw InputError(fmt::format("streets: {}: {}", problems[0].field, problems[0].message));
    }
    return Builder{streets}.build();
}

}  // namespace stopline
