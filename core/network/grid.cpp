#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "network/conflicts.h"

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

// Arms by where their traffic comes from, and by where it goes to: an arm's traffic that goes straight on leaves opposite.
constexpr std::array<const char*, 4> kFrom{"west", "south", "east", "north"};
constexpr std::array<const char*, 4> kTo{"east", "north", "west", "south"};

const char* name_of(Turn turn) { return turn == Turn::left ? "left" : turn == Turn::right ? "right" : "straight"; }

bool allows(const IntersectionSettings::LaneMovements& lane, Turn turn) { return lane.allows(name_of(turn)); }

Polyline moved(Polyline line, Point by) {
    for (Point& point : line) point = {point.x_m + by.x_m, point.y_m + by.y_m};
    return line;
}

struct Builder {
    const GridSettings& grid;
    const IntersectionSettings& s;
    std::vector<GridPlace> places = grid_places(grid);
    LaneGraph graph = {};
    std::vector<int> in = {};         // [(intersection, arm, lane)] lane that leads to it
    std::vector<int> out = {};        // [(intersection, direction, lane)] lane that leads away
    std::vector<int> node_at = {};    // [row * columns + column] intersection; -1: none
    std::vector<double> shared = {};  // [lane] see shared_stretch
    int first_inside = 0;             // number of the first lane inside an intersection

    int lanes() const { return static_cast<int>(s.lanes.size()); }
    // Lanes are counted from the left: lane 0 is next to the middle of the road. Right-hand traffic.
    double offset_m(int lane) const { return (lane + 0.5) * s.lane_width_m; }
    std::size_t index(int node, int arm, int lane) const { return at((node * 4 + arm) * lanes() + lane); }

    Point centre(int node) const {
        return {places[at(node)].column * grid.column_spacing_m, places[at(node)].row * grid.row_spacing_m};
    }
    std::string prefix(int node) const {
        return places.size() == 1 ? "" : fmt::format("c{}r{}_", places[at(node)].column, places[at(node)].row);
    }
    double spacing_m(int arm) const { return arm % 2 == 0 ? grid.column_spacing_m : grid.row_spacing_m; }

    // The intersection that one comes to when leaving in a direction; -1: none.
    int neighbour(int node, int direction) const {
        constexpr std::array<GridPlace, 4> kStep{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
        const int column = places[at(node)].column + kStep[at(direction)].column;
        const int row = places[at(node)].row + kStep[at(direction)].row;
        const bool within = column >= 0 && column < grid.columns && row >= 0 && row < grid.rows;
        return within ? node_at[at(row * grid.columns + column)] : -1;
    }

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

    int add(const Lane& lane) {
        graph.lanes.push_back(lane);
        return static_cast<int>(graph.lanes.size()) - 1;
    }

    Lane approach(int node, int arm, int k) const {
        const bool link = neighbour(node, (arm + 2) % 4) >= 0;
        const double y = -offset_m(k);
        Lane lane;
        lane.name = fmt::format("{}{}_in_{}", prefix(node), kFrom[at(arm)], k);
        lane.limit_mps = s.speed_limit_mps;
        lane.signal_group = 2 * node + arm % 2;
        lane.stop_line_m = link ? spacing_m(arm) - 2.0 * s.radius_m : s.approach_length_m;
        lane.length_m = lane.stop_line_m + shared_m(k);
        lane.shape = moved(rotated({{-s.radius_m - lane.stop_line_m, y}, {-s.radius_m, y}}, arm), centre(node));
        return lane;
    }

    Lane exit(int node, int direction, int k) const {
        const double y = -offset_m(k);
        Lane lane;
        lane.name = fmt::format("{}{}_out_{}", prefix(node), kTo[at(direction)], k);
        lane.limit_mps = s.speed_limit_mps;
        lane.length_m = s.exit_length_m;
        lane.shape = moved(rotated({{s.radius_m, y}, {s.radius_m + s.exit_length_m, y}}, direction), centre(node));
        return lane;
    }

    void add_arms(int node) {
        for (int arm = 0; arm < 4; ++arm) {
            for (int k = 0; k < lanes(); ++k) {
                const int entry = add(approach(node, arm, k));
                in[index(node, arm, k)] = entry;
                const int from = neighbour(node, (arm + 2) % 4);
                (from < 0 ? graph.entries : graph.links).push_back(entry);
                if (from >= 0) out[index(from, arm, k)] = entry;
                if (neighbour(node, arm) < 0) out[index(node, arm, k)] = add(exit(node, arm, k));
            }
        }
    }

    double shared_m(int lane) const { return shared[at(lane)]; }
    double shared_stretch(int lane) const {
        double most_m = 0.0;
        for (const Turn one : {Turn::straight, Turn::right, Turn::left}) {
            for (const Turn two : {Turn::straight, Turn::right, Turn::left}) {
                if (one == two || !allows(s.lanes[at(lane)], one) || !allows(s.lanes[at(lane)], two)) continue;
                most_m = std::max(most_m, shared_stretch_m(path(one, lane), path(two, lane), s.clearance_m));
            }
        }
        return most_m;
    }

    Lane inside(int node, int arm, int k, Turn turn) const {
        Lane lane;
        lane.name = fmt::format("{}{}_{}_{}", prefix(node), kFrom[at(arm)], k, name_of(turn));
        lane.shape = moved(rotated(path(turn, k), arm), centre(node));
        lane.shape_start_m = shared_m(k);
        lane.length_m = length_m(path(turn, k)) - lane.shape_start_m;
        lane.limit_mps = turn == Turn::straight ? s.speed_limit_mps : s.turn_speed_mps;
        lane.turn = turn;
        lane.origin = in[index(node, arm, k)];
        const int ahead = turn == Turn::straight ? 0 : turn == Turn::left ? 1 : 3;
        lane.next = {out[index(node, (arm + ahead) % 4, target_lane(turn, k))]};
        return lane;
    }

    void add_inside(int node) {
        for (int arm = 0; arm < 4; ++arm) {
            for (int k = 0; k < lanes(); ++k) {
                for (const Turn turn : {Turn::straight, Turn::right, Turn::left}) {
                    if (!allows(s.lanes[at(k)], turn)) continue;
                    const Lane lane = inside(node, arm, k, turn);
                    const int number = add(lane);
                    graph.lanes[at(lane.origin)].next.push_back(number);
                    graph.routes.push_back({lane.name, {lane.origin, number, lane.next[0]}});
                }
            }
        }
    }

    // Intersections are alike, and their lanes inside are numbered alike: what holds for the first one holds for all.
    void find_conflicts_of_all(int nodes) {
        graph.conflicts.assign(graph.lanes.size(), {});
        const auto count = static_cast<int>(graph.lanes.size());
        const int each = (count - first_inside) / nodes;
        find_conflicts(graph, s.clearance_m, first_inside, first_inside + each);
        for (int lane = first_inside + each; lane < count; ++lane) {
            const int like = first_inside + (lane - first_inside) % each;
            graph.conflicts[at(lane)] = graph.conflicts[at(like)];
            for (Conflict& conflict : graph.conflicts[at(lane)]) conflict.other += lane - like;
        }
    }

    LaneGraph build() {
        const auto nodes = static_cast<int>(places.size());
        graph.signal_groups = 2 * nodes;
        node_at.assign(at(grid.columns * grid.rows), -1);
        for (int node = 0; node < nodes; ++node) {
            node_at[at(places[at(node)].row * grid.columns + places[at(node)].column)] = node;
        }
        for (int k = 0; k < lanes(); ++k) shared.push_back(shared_stretch(k));
        in.assign(index(nodes, 0, 0), -1);
        out.assign(index(nodes, 0, 0), -1);
        for (int node = 0; node < nodes; ++node) add_arms(node);
        first_inside = static_cast<int>(graph.lanes.size());
        for (int node = 0; node < nodes; ++node) add_inside(node);
        find_conflicts_of_all(nodes);
        return std::move(graph);
    }
};

}  // namespace

std::vector<GridPlace> grid_places(const GridSettings& grid) {
    std::vector<GridPlace> places;
    for (int row = 0; row < grid.rows; ++row) {
        for (int column = 0; column < grid.columns; ++column) {
            const bool corner = (row == 0 || row == grid.rows - 1) && (column == 0 || column == grid.columns - 1);
            if (grid.has_corners() || !corner) places.push_back({column, row});
        }
    }
    return places;
}

LaneGraph make_grid(const GridSettings& grid, const IntersectionSettings& settings) {
    return Builder{grid, settings}.build();
}

LaneGraph make_intersection(const IntersectionSettings& settings) { return make_grid({}, settings); }

}  // namespace stopline
