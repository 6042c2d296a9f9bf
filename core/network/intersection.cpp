#include <algorithm>
#include <array>
#include <cstddef>

#include <fmt/format.h>

#include "base/input_error.h"
#include "network/conflicts.h"

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

// Arms by where their traffic comes from, and by where it goes to: an arm's traffic that goes straight on leaves opposite.
constexpr std::array<const char*, 4> kFrom{"west", "south", "east", "north"};
constexpr std::array<const char*, 4> kTo{"east", "north", "west", "south"};

bool allows(const IntersectionSettings::LaneMovements& lane, Turn turn) {
    return lane.movements.find(turn == Turn::left    ? "left"
                               : turn == Turn::right ? "right"
                                                     : "straight") != std::string::npos;
}

const char* name_of(Turn turn) { return turn == Turn::left ? "left" : turn == Turn::right ? "right" : "straight"; }

struct Builder {
    const IntersectionSettings& s;
    LaneGraph graph;

    int lanes() const { return static_cast<int>(s.lanes.size()); }
    // Lanes are counted from the left: lane 0 is next to the middle of the road. Right-hand traffic.
    double offset_m(int lane) const { return (lane + 0.5) * s.lane_width_m; }
    int entry(int arm, int lane) const { return 2 * (arm * lanes() + lane); }
    int exit(int direction, int lane) const { return 2 * (direction * lanes() + lane) + 1; }

    // Turning lanes lead to the exit lane next to them, counted from the side they turn to.
    int target_lane(Turn turn, int lane) const {
        int before = 0;
        if (turn == Turn::straight) return lane;
        if (turn == Turn::left) {
            for (int k = 0; k < lane; ++k) before += allows(s.lanes[at(k)], turn) ? 1 : 0;
            return before;
        }
        for (int k = lane + 1; k < lanes(); ++k) before += allows(s.lanes[at(k)], turn) ? 1 : 0;
        return lanes() - 1 - before;
    }

    // Seen by traffic that heads along +x, from the stop line to the exit.
    Polyline path(Turn turn, int lane) const {
        const double r = s.radius_m;
        const Point from{-r, -offset_m(lane)};
        const double x_m = offset_m(target_lane(turn, lane));
        if (turn == Turn::straight) return {from, {r, -offset_m(lane)}};
        return turn == Turn::left ? quarter_turn(from, {x_m, r}) : quarter_turn(from, {-x_m, -r});
    }

    void add_arms() {
        for (int arm = 0; arm < 4; ++arm) {
            for (int k = 0; k < lanes(); ++k) {
                const double y = -offset_m(k);
                Lane in;
                in.name = fmt::format("{}_in_{}", kFrom[at(arm)], k);
                in.limit_mps = s.speed_limit_mps;
                in.signal_group = arm % 2;
                in.stop_line_m = s.approach_length_m;
                in.length_m = s.approach_length_m + shared_m(k);
                in.shape = rotated({{-s.radius_m - s.approach_length_m, y}, {-s.radius_m, y}}, arm);
                Lane out;
                out.name = fmt::format("{}_out_{}", kTo[at(arm)], k);
                out.limit_mps = s.speed_limit_mps;
                out.length_m = s.exit_length_m;
                out.shape = rotated({{s.radius_m, y}, {s.radius_m + s.exit_length_m, y}}, arm);
                graph.lanes.push_back(in);
                graph.lanes.push_back(out);
                graph.entries.push_back(entry(arm, k));
            }
        }
    }

    double shared_m(int lane) const {
        double most_m = 0.0;
        for (const Turn one : {Turn::straight, Turn::right, Turn::left}) {
            for (const Turn two : {Turn::straight, Turn::right, Turn::left}) {
                if (one == two || !allows(s.lanes[at(lane)], one) || !allows(s.lanes[at(lane)], two)) continue;
                most_m = std::max(most_m, shared_stretch_m(path(one, lane), path(two, lane), s.clearance_m));
            }
        }
        return most_m;
    }

    void add_inside() {
        for (int arm = 0; arm < 4; ++arm) {
            for (int k = 0; k < lanes(); ++k) {
                for (const Turn turn : {Turn::straight, Turn::right, Turn::left}) {
                    if (!allows(s.lanes[at(k)], turn)) continue;
                    const int ahead = turn == Turn::straight ? 0 : turn == Turn::left ? 1 : 3;
                    Lane inside;
                    inside.name = fmt::format("{}_{}_{}", kFrom[at(arm)], k, name_of(turn));
                    inside.shape = rotated(path(turn, k), arm);
                    inside.shape_start_m = shared_m(k);
                    inside.length_m = length_m(inside.shape) - inside.shape_start_m;
                    inside.limit_mps = turn == Turn::straight ? s.speed_limit_mps : s.turn_speed_mps;
                    inside.turn = turn;
                    inside.origin = entry(arm, k);
                    const int to = exit((arm + ahead) % 4, target_lane(turn, k));
                    inside.next = {to};
                    const auto index = static_cast<int>(graph.lanes.size());
                    graph.lanes[at(inside.origin)].next.push_back(index);
                    graph.routes.push_back({inside.name, {inside.origin, index, to}});
                    graph.lanes.push_back(inside);
                }
            }
        }
    }
};

}  // namespace

LaneGraph make_intersection(const IntersectionSettings& settings) {
    Builder builder{settings, {}};
    builder.graph.signal_groups = 2;
    builder.add_arms();
    builder.add_inside();
    find_conflicts(builder.graph, settings.clearance_m);
    return builder.graph;
}

}  // namespace stopline
