#include "network/generators/street_layout.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <utility>

#include "base/containers/index.h"

namespace stopline {

namespace {

constexpr std::size_t kWest = 0;  // sides, as in kSides
constexpr std::size_t kSouth = 1;
constexpr std::size_t kEast = 2;
constexpr std::size_t kNorth = 3;
constexpr double kSameLine_m = 1.0;  // intersections with at most this sideways offset lie on one straight road

}  // namespace

const char* name_of(Turn turn) { return turn == Turn::left ? "left" : turn == Turn::right ? "right" : "straight"; }

bool allows(const StreetLane& lane, Turn turn) { return lane.movements.find(name_of(turn)) != std::string::npos; }

int exit_side(int side, Turn turn) { return (side + (turn == Turn::straight ? 2 : turn == Turn::right ? 1 : 3)) % 4; }

std::vector<int> lanes_with(const StreetLeg& leg, Turn turn) {
    std::vector<int> lanes;
    for (int k = 0; k < static_cast<int>(leg.lanes.size()); ++k) {
        if (allows(leg.lanes[at(k)], turn)) lanes.push_back(k);
    }
    if (turn == Turn::right) std::reverse(lanes.begin(), lanes.end());
    return lanes;
}

StreetLayout::StreetLayout(const StreetSettings& streets) : streets_(&streets) {
    for (const StreetIntersection& node : streets.intersections) {
        std::array<int, 4> legs{-1, -1, -1, -1};
        for (int k = 0; k < static_cast<int>(node.legs.size()); ++k) {
            const auto* const side = std::find(kSides.begin(), kSides.end(), node.legs[at(k)].from);
            if (side != kSides.end()) legs[at(static_cast<int>(side - kSides.begin()))] = k;
        }
        legs_.push_back(legs);
    }
    find_nearest();
}

const StreetLeg* StreetLayout::leg(int n, int side) const {
    const int index = legs_[at(n)][at(side)];
    return index < 0 ? nullptr : &node(n).legs[at(index)];
}

void StreetLayout::find_nearest() {
    nearest_.assign(legs_.size(), {-1, -1, -1, -1});
    for (const bool eastward : {true, false}) {
        const auto along_m = [&](int n) { return eastward ? node(n).x_m : node(n).y_m; };
        const auto across_m = [&](int n) { return eastward ? node(n).y_m : node(n).x_m; };
        // The plane is divided into strips of the width kSameLine_m. Intersections on one line are in the same strip or
        // in adjacent strips. For each intersection, its strip holds the position along the strip and the index.
        std::map<double, std::vector<std::pair<double, int>>> strips;
        for (int n = 0; n < nodes(); ++n) strips[std::floor(across_m(n) / kSameLine_m)].emplace_back(along_m(n), n);
        for (auto& [strip, places] : strips) std::sort(places.begin(), places.end());
        const auto is_on_line = [&](int n, int other) {
            return std::abs(across_m(other) - across_m(n)) <= kSameLine_m;
        };
        for (int n = 0; n < nodes(); ++n) {
            double ahead_m = std::numeric_limits<double>::infinity();
            double behind_m = std::numeric_limits<double>::infinity();
            int& ahead = nearest_[at(n)][eastward ? kEast : kNorth];
            int& behind = nearest_[at(n)][eastward ? kWest : kSouth];
            // Of several intersections at the same distance, the one with the lowest index counts.
            const auto take = [&](int other, double distance_m, int& nearest, double& nearest_m) {
                if (distance_m > nearest_m || (distance_m == nearest_m && other > nearest)) return;
                nearest = other;
                nearest_m = distance_m;
            };
            const double own_strip = std::floor(across_m(n) / kSameLine_m);
            for (const double strip : {own_strip - 1.0, own_strip, own_strip + 1.0}) {
                const auto found = strips.find(strip);
                if (found == strips.end()) continue;
                const std::vector<std::pair<double, int>>& places = found->second;
                const auto first_ahead = std::upper_bound(places.begin(), places.end(), std::pair{along_m(n), nodes()});
                for (auto place = first_ahead; place != places.end() && place->first - along_m(n) <= ahead_m; ++place) {
                    if (is_on_line(n, place->second)) take(place->second, place->first - along_m(n), ahead, ahead_m);
                }
                const auto first_level = std::lower_bound(places.begin(), places.end(), std::pair{along_m(n), -1});
                for (auto place = first_level; place != places.begin();) {
                    --place;
                    if (along_m(n) - place->first > behind_m) break;
                    if (is_on_line(n, place->second)) take(place->second, along_m(n) - place->first, behind, behind_m);
                }
            }
        }
    }
}

int StreetLayout::neighbour(int n, int side) const {
    const int other = nearest(n, side);
    return other >= 0 && leg(n, side) != nullptr && leg(other, opposite(side)) != nullptr ? other : -1;
}

int StreetLayout::left_pockets(const StreetLeg& leg) {
    int count = 0;
    for (const StreetLane& lane : leg.lanes) {
        if (lane.pocket_m <= 0.0) return count;
        ++count;
    }
    return count;
}

int StreetLayout::through_lanes(const StreetLeg& leg) {
    return static_cast<int>(
        std::count_if(leg.lanes.begin(), leg.lanes.end(), [](const StreetLane& lane) { return lane.pocket_m <= 0.0; }));
}

double StreetLayout::offset_m(int n, int side, int lane) const {
    return exit_offset_m(side, lane - left_pockets(*leg(n, side)));
}

double StreetLayout::exit_offset_m(int side, int lane) const {
    return 0.5 * median_m(side) + (lane + 0.5) * streets_->lane_width_m;
}

Point StreetLayout::point_at(int n, int side, double ahead_m, double right_m) const {
    const Point p = rotated({{ahead_m, -right_m}}, side)[0];
    return {node(n).x_m + p.x_m, node(n).y_m + p.y_m};
}

double StreetLayout::length_m(int n, int side) const {
    const int from = neighbour(n, side);
    if (from < 0) return leg(n, side)->length_m;
    const Point begin = point_at(from, side, node(from).radius_m, 0.0);
    const Point end = point_at(n, side, -node(n).radius_m, 0.0);
    return std::hypot(end.x_m - begin.x_m, end.y_m - begin.y_m);
}

int StreetLayout::straight_shift(int n, int side) const {
    const std::vector<int> lanes = lanes_with(*leg(n, side), Turn::straight);
    const int spare = leg(n, opposite(side))->exits - static_cast<int>(lanes.size());
    int best = 0;
    double best_m = std::numeric_limits<double>::infinity();
    for (int shift = 0; shift <= spare; ++shift) {
        double sum_m = 0.0;
        for (int k = 0; k < static_cast<int>(lanes.size()); ++k) {
            sum_m += std::abs(offset_m(n, side, lanes[at(k)]) - exit_offset_m(opposite(side), k + shift));
        }
        if (sum_m < best_m - 1e-9) {
            best = shift;
            best_m = sum_m;
        }
    }
    return best;
}

int StreetLayout::exit_lane(int n, int side, int lane, Turn turn) const {
    const std::vector<int> lanes = lanes_with(*leg(n, side), turn);
    const auto rank = static_cast<int>(std::find(lanes.begin(), lanes.end(), lane) - lanes.begin());
    if (turn == Turn::left) return rank;
    if (turn == Turn::right) return leg(n, exit_side(side, turn))->exits - 1 - rank;
    return rank + straight_shift(n, side);
}

Polyline StreetLayout::path(int n, int side, int lane, Turn turn) const {
    const double r = node(n).radius_m;
    const Point from{-r, -offset_m(n, side, lane)};
    const double out_m = exit_offset_m(exit_side(side, turn), exit_lane(n, side, lane, turn));
    const Polyline eastbound = turn == Turn::straight ? Polyline{from, {r, -out_m}}
                               : turn == Turn::left   ? quarter_turn(from, {out_m, r})
                                                      : quarter_turn(from, {-out_m, -r});
    Polyline line;
    for (const Point& p : eastbound) line.push_back(point_at(n, side, p.x_m, -p.y_m));
    return line;
}

Polyline StreetLayout::approach(int n, int side, int lane) const {
    const double right_m = offset_m(n, side, lane);
    const double whole_m = length_m(n, side);
    const double pocket_m = leg(n, side)->lanes[at(lane)].pocket_m;
    const int from = neighbour(n, side);
    const Point end = point_at(n, side, -node(n).radius_m, right_m);
    const Point begin = from < 0 ? point_at(n, side, -node(n).radius_m - whole_m, right_m)
                                 : point_at(from, side, node(from).radius_m, right_m);
    const double share = pocket_m > 0.0 ? pocket_m / whole_m : 1.0;
    return {{end.x_m + share * (begin.x_m - end.x_m), end.y_m + share * (begin.y_m - end.y_m)}, end};
}

Polyline StreetLayout::exit(int n, int side, int lane) const {
    const double r = node(n).radius_m;
    const int from = opposite(side);
    const double right_m = exit_offset_m(side, lane);
    return {point_at(n, from, r, right_m), point_at(n, from, r + leg(n, side)->exit_length_m, right_m)};
}

}  // namespace stopline
