// The lane graph of a grid of equal intersections, and of a single intersection.
#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "base/containers/index.h"
#include "network/conflicts.h"

namespace stopline {

namespace {

// Driving directions are numbered 0 east, 1 north, 2 west, 3 south. On the approach lanes of leg k, vehicles drive in
// direction k.
constexpr std::array<const char*, 4> kFrom{"west", "south", "east", "north"};  // [leg] side of the intersection
constexpr std::array<const char*, 4> kTo{"east", "north", "west", "south"};    // [direction] name

const char* name_of(Turn turn) { return turn == Turn::left ? "left" : turn == Turn::right ? "right" : "straight"; }

bool allows(const IntersectionSettings::LaneMovements& lane, Turn turn) { return lane.allows(name_of(turn)); }

Polyline moved(Polyline line, Point by) {
    for (Point& point : line) point = {point.x_m + by.x_m, point.y_m + by.y_m};
    return line;
}

struct Builder {
    const GridSettings& grid;
    const IntersectionSettings& s;
    std::vector<GridPosition> positions = grid_positions(grid);
    LaneGraph graph = {};
    std::vector<int> in = {};         // [index(intersection, leg, lane)] approach lane
    std::vector<int> out = {};        // [index(intersection, direction, lane)] exit lane
    std::vector<int> node_at = {};    // [row * columns + column] intersection; -1: none
    std::vector<double> shared = {};  // [lane of a leg] shared_stretch() of the approach lane, m; equal on all legs
    int first_connection = 0;         // index of the first connection in graph.lanes

    int lanes() const { return static_cast<int>(s.lanes.size()); }
    // Returns the distance of the lane's centre line from the middle of the road. Traffic keeps right, and lane 0 is
    // the leftmost lane.
    double offset_m(int lane) const { return (lane + 0.5) * s.lane_width_m; }
    std::size_t index(int node, int leg, int lane) const { return at((node * 4 + leg) * lanes() + lane); }

    Point centre(int node) const {
        return {positions[at(node)].column * grid.column_spacing_m, positions[at(node)].row * grid.row_spacing_m};
    }
    std::string prefix(int node) const {
        return positions.size() == 1 ? "" : fmt::format("c{}r{}_", positions[at(node)].column, positions[at(node)].row);
    }
    double spacing_m(int leg) const { return leg % 2 == 0 ? grid.column_spacing_m : grid.row_spacing_m; }

    // Returns the next intersection in a direction, or -1 if there is none.
    int neighbour(int node, int direction) const {
        constexpr std::array<GridPosition, 4> kStep{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
        const int column = positions[at(node)].column + kStep[at(direction)].column;
        const int row = positions[at(node)].row + kStep[at(direction)].row;
        const bool within = column >= 0 && column < grid.columns && row >= 0 && row < grid.rows;
        return within ? node_at[at(row * grid.columns + column)] : -1;
    }

    // Returns the index of the exit lane to which an approach lane leads. The leftmost lane with a left turn leads to
    // the leftmost exit lane, the second such lane to the second exit lane, and so on. Right turns are assigned in the
    // same way, counted from the right. A movement straight on leads to the exit lane with the index of the approach
    // lane.
    int exit_lane(Turn turn, int lane) const {
        int rank = 0;  // number of lanes with the same turn further left (left turn) or right (right turn)
        if (turn == Turn::straight) return lane;
        if (turn == Turn::left) {
            for (int k = 0; k < lane; ++k) rank += allows(s.lanes[at(k)], turn) ? 1 : 0;
            return rank;
        }
        for (int k = lane + 1; k < lanes(); ++k) rank += allows(s.lanes[at(k)], turn) ? 1 : 0;
        return lanes() - 1 - rank;
    }

    // Returns the path from the stop line to the exit lane. The origin of the coordinates is the centre of the
    // intersection, and the vehicle arrives in direction +x.
    Polyline path(Turn turn, int lane) const {
        const double r = s.radius_m;
        const Point from{-r, -offset_m(lane)};
        const double x_m = offset_m(exit_lane(turn, lane));
        if (turn == Turn::straight) return {from, {r, -offset_m(lane)}};
        return turn == Turn::left ? quarter_turn(from, {x_m, r}) : quarter_turn(from, {-x_m, -r});
    }

    int add(const Lane& lane) {
        graph.lanes.push_back(lane);
        return static_cast<int>(graph.lanes.size()) - 1;
    }

    Lane approach(int node, int leg, int k) const {
        const bool link = neighbour(node, (leg + 2) % 4) >= 0;
        const double y = -offset_m(k);
        Lane lane;
        lane.name = fmt::format("{}{}_in_{}", prefix(node), kFrom[at(leg)], k);
        lane.limit_mps = s.speed_limit_mps;
        lane.signal_group = 2 * node + leg % 2;
        lane.stop_line_m = link ? spacing_m(leg) - 2.0 * s.radius_m : s.approach_length_m;
        lane.length_m = lane.stop_line_m + shared_m(k);
        lane.shape = moved(rotated({{-s.radius_m - lane.stop_line_m, y}, {-s.radius_m, y}}, leg), centre(node));
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

    void add_legs(int node) {
        for (int leg = 0; leg < 4; ++leg) {
            for (int k = 0; k < lanes(); ++k) {
                const int entry = add(approach(node, leg, k));
                in[index(node, leg, k)] = entry;
                const int from = neighbour(node, (leg + 2) % 4);
                (from < 0 ? graph.entries : graph.links).push_back(entry);
                if (from >= 0) out[index(from, leg, k)] = entry;
                if (neighbour(node, leg) < 0) out[index(node, leg, k)] = add(exit(node, leg, k));
            }
        }
    }

    double shared_m(int lane) const { return shared[at(lane)]; }
    // Returns the distance from the stop line at which all movements of the lane have diverged, m.
    double shared_stretch(int lane) const {
        double longest_m = 0.0;
        for (const Turn one : {Turn::straight, Turn::right, Turn::left}) {
            for (const Turn two : {Turn::straight, Turn::right, Turn::left}) {
                if (one == two || !allows(s.lanes[at(lane)], one) || !allows(s.lanes[at(lane)], two)) continue;
                longest_m = std::max(longest_m, shared_stretch_m(path(one, lane), path(two, lane), s.clearance_m));
            }
        }
        return longest_m;
    }

    Lane connection(int node, int leg, int k, Turn turn) const {
        Lane lane;
        lane.name = fmt::format("{}{}_{}_{}", prefix(node), kFrom[at(leg)], k, name_of(turn));
        lane.shape = moved(rotated(path(turn, k), leg), centre(node));
        lane.shape_start_m = shared_m(k);
        lane.length_m = length_m(path(turn, k)) - lane.shape_start_m;
        lane.limit_mps = turn == Turn::straight ? s.speed_limit_mps : s.turn_speed_mps;
        lane.turn = turn;
        lane.origin = in[index(node, leg, k)];
        const int rotation = turn == Turn::straight ? 0 : turn == Turn::left ? 1 : 3;  // quarter turns to the left
        lane.next = {out[index(node, (leg + rotation) % 4, exit_lane(turn, k))]};
        return lane;
    }

    void add_connections(int node) {
        for (int leg = 0; leg < 4; ++leg) {
            for (int k = 0; k < lanes(); ++k) {
                for (const Turn turn : {Turn::straight, Turn::right, Turn::left}) {
                    if (!allows(s.lanes[at(k)], turn)) continue;
                    const Lane lane = connection(node, leg, k, turn);
                    const int number = add(lane);
                    graph.lanes[at(lane.origin)].next.push_back(number);
                    graph.routes.push_back({lane.name, {lane.origin, number, lane.next[0]}});
                }
            }
        }
    }

    // Finds the conflicts of the first intersection and copies them to all others. This is possible because all
    // intersections are equal and have their connections in the same order.
    void find_all_conflicts(int nodes) {
        graph.conflicts.assign(graph.lanes.size(), {});
        const auto count = static_cast<int>(graph.lanes.size());
        const int per_node = (count - first_connection) / nodes;
        find_conflicts(graph, s.clearance_m, first_connection, first_connection + per_node);
        for (int lane = first_connection + per_node; lane < count; ++lane) {
            const int original = first_connection + (lane - first_connection) % per_node;
            graph.conflicts[at(lane)] = graph.conflicts[at(original)];
            for (Conflict& conflict : graph.conflicts[at(lane)]) conflict.other += lane - original;
        }
    }

    LaneGraph build() {
        const auto nodes = static_cast<int>(positions.size());
        graph.signal_groups = 2 * nodes;
        node_at.assign(at(grid.columns * grid.rows), -1);
        for (int node = 0; node < nodes; ++node) {
            node_at[at(positions[at(node)].row * grid.columns + positions[at(node)].column)] = node;
        }
        for (int k = 0; k < lanes(); ++k) shared.push_back(shared_stretch(k));
        in.assign(index(nodes, 0, 0), -1);
        out.assign(index(nodes, 0, 0), -1);
        for (int node = 0; node < nodes; ++node) add_legs(node);
        first_connection = static_cast<int>(graph.lanes.size());
        for (int node = 0; node < nodes; ++node) add_connections(node);
        find_all_conflicts(nodes);
        return std::move(graph);
    }
};

}  // namespace

std::vector<GridPosition> grid_positions(const GridSettings& grid) {
    std::vector<GridPosition> positions;
    for (int row = 0; row < grid.rows; ++row) {
        for (int column = 0; column < grid.columns; ++column) {
            const bool corner = (row == 0 || row == grid.rows - 1) && (column == 0 || column == grid.columns - 1);
            if (grid.has_corners() || !corner) positions.push_back({column, row});
        }
    }
    return positions;
}

LaneGraph make_grid(const GridSettings& grid, const IntersectionSettings& settings) {
    return Builder{grid, settings}.build();
}

LaneGraph make_intersection(const IntersectionSettings& settings) { return make_grid({}, settings); }

}  // namespace stopline
