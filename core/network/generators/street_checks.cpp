#include "network/generators/street_checks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <unordered_set>
#include <utility>

#include <fmt/format.h>

#include "base/containers/index.h"
#include "network/generators/street_layout.h"

namespace stopline {

namespace {

constexpr double kMinLink_m = 10.0;  // minimum length of a road between two intersections
constexpr double kTolerance = 1e-9;

class Checks {
public:
    explicit Checks(const StreetSettings& streets) : s_(streets), layout_(streets) {}

    std::vector<StreetProblem> run() {
        const std::string clearance_message = clearance_problem(s_.clearance_m, s_.lane_width_m);
        if (!clearance_message.empty()) add_problem("clearance", clearance_message);
        const double passing_m = s_.passing_clearance_m;
        if (passing_m > 0.0 && (passing_m < s_.clearance_m || passing_m > s_.lane_width_m + kTolerance)) {
            add_problem("passing_clearance",
                        fmt::format("value {:g} m must lie between clearance, {:g} m, and lane_width, {:g} m",
                                    passing_m, s_.clearance_m, s_.lane_width_m));
        }
        std::unordered_set<std::string> names;
        for (int n = 0; n < layout_.nodes(); ++n) {
            check_name_and_sides(n, names);
            check_programme(n);
        }
        if (problems_.empty()) check_distances();
        if (problems_.empty()) for_each_leg(&Checks::check_lane_order);
        if (problems_.empty()) for_each_leg(&Checks::check_width);
        if (problems_.empty()) for_each_leg(&Checks::check_turns);
        if (problems_.empty()) for_each_leg(&Checks::check_roads);
        if (problems_.empty()) for_each_leg(&Checks::check_pockets);
        return std::move(problems_);
    }

private:
    struct Leg {
        int node;
        int side;
        const StreetLeg& settings;
        std::string field;
    };

    void add_problem(std::string field, std::string message) {
        problems_.push_back({std::move(field), std::move(message)});
    }
    std::string field_of(int n) const { return fmt::format("intersections[{}]", layout_.node(n).name); }

    void for_each_leg(void (Checks::*check)(const Leg&)) {
        for (int n = 0; n < layout_.nodes(); ++n) {
            const StreetIntersection& node = layout_.node(n);
            for (std::size_t k = 0; k < node.legs.size(); ++k) {
                const auto* const side = std::find(kSides.begin(), kSides.end(), node.legs[k].from);
                (this->*check)({n, static_cast<int>(side - kSides.begin()), node.legs[k],
                                fmt::format("{}.legs[{}]", field_of(n), k)});
            }
        }
    }

    // Checks the name of intersection n and the sides of its legs. `names` holds the names of the intersections before
    // n, and the function adds the name of n.
    void check_name_and_sides(int n, std::unordered_set<std::string>& names) {
        const StreetIntersection& node = layout_.node(n);
        if (!names.insert(node.name).second) {
            add_problem(field_of(n) + ".name", fmt::format("the name '{}' appears twice", node.name));
        }
        if (node.legs.size() < 2) add_problem(field_of(n) + ".legs", "at least two legs are needed");
        for (std::size_t a = 0; a < node.legs.size(); ++a) {
            const std::string field = fmt::format("{}.legs[{}].from", field_of(n), a);
            const std::string& from = node.legs[a].from;
            if (std::find(kSides.begin(), kSides.end(), from) == kSides.end()) {
                add_problem(field,
                            fmt::format("there is no side '{}'; the sides are west, south, east and north", from));
            }
            for (std::size_t b = 0; b < a; ++b) {
                if (node.legs[b].from == from) {
                    add_problem(field,
                                fmt::format("there is already a leg in the {}: each side may have one leg", from));
                }
            }
        }
    }

    void check_programme(int n) {
        const SevenSteps& own = layout_.node(n).programme;
        const StreetIntersection& first = layout_.node(0);
        const std::string field = field_of(n) + ".programme";
        if (std::abs(own.cycle_s() - first.programme.cycle_s()) > kTolerance) {
            add_problem(
                field,
                fmt::format("its seven steps sum to a cycle of {:g} s, those of '{}' to {:g} s: all intersections "
                            "must have the same cycle",
                            own.cycle_s(), first.name, first.programme.cycle_s()));
        }
        if (own.major_green_s <= 0.0) add_problem(field + ".major_green", "the major street needs a green above 0 s");
        const auto has_lanes = [&](int side) {
            return layout_.leg(n, side) != nullptr && !layout_.leg(n, side)->lanes.empty();
        };
        if (own.minor_green_s <= 0.0 && (has_lanes(1) || has_lanes(3))) {
            add_problem(field + ".minor_green", "the legs in the south and north need a green above 0 s");
        }
    }

    // Checks the distances between intersections. The plane is divided into squares as wide as the largest distance
    // that two intersections need. So each intersection is compared only with those in its own and the adjacent
    // squares.
    void check_distances() {
        double square_m = kMinLink_m;
        for (int n = 0; n < layout_.nodes(); ++n) {
            square_m = std::max(square_m, 2.0 * layout_.node(n).radius_m + kMinLink_m);
        }
        const auto square_of = [&](int n) {
            return std::pair{std::floor(layout_.node(n).x_m / square_m), std::floor(layout_.node(n).y_m / square_m)};
        };
        std::map<std::pair<double, double>, std::vector<int>> squares;
        for (int n = 0; n < layout_.nodes(); ++n) {
            const auto [column, row] = square_of(n);
            std::vector<int> others;
            for (const double right : {-1.0, 0.0, 1.0}) {
                for (const double up : {-1.0, 0.0, 1.0}) {
                    const auto found = squares.find({column + right, row + up});
                    if (found == squares.end()) continue;
                    others.insert(others.end(), found->second.begin(), found->second.end());
                }
            }
            std::sort(others.begin(), others.end());
            for (const int other : others) check_distance(n, other);
            squares[{column, row}].push_back(n);
        }
    }

    void check_distance(int n, int other) {
        const StreetIntersection& a = layout_.node(n);
        const StreetIntersection& b = layout_.node(other);
        const double distance_m = std::hypot(a.x_m - b.x_m, a.y_m - b.y_m);
        if (distance_m >= a.radius_m + b.radius_m + kMinLink_m) return;
        add_problem(field_of(n) + ".x",
                    fmt::format("the centre is only {:g} m from '{}': both radii and {:g} m of road need {:g} m",
                                distance_m, b.name, kMinLink_m, a.radius_m + b.radius_m + kMinLink_m));
    }

    // Checks that the lanes serve, from left to right, first left turns, then straight traffic, then right turns. In
    // another order, connections of the same approach would cross. Also checks that the turn pockets lie beside the
    // lanes that are as long as the approach, and that there is such a lane.
    void check_lane_order(const Leg& leg) {
        const auto& lanes = leg.settings.lanes;
        for (std::size_t k = 1; k < lanes.size(); ++k) {
            constexpr std::array<Turn, 3> kFromTheLeft{Turn::left, Turn::straight, Turn::right};
            for (std::size_t a = 0; a < kFromTheLeft.size(); ++a) {
                for (std::size_t b = 0; b < a; ++b) {
                    if (!allows(lanes[k - 1], kFromTheLeft[a]) || !allows(lanes[k], kFromTheLeft[b])) continue;
                    add_problem(fmt::format("{}.lanes[{}].movements", leg.field, k),
                                fmt::format("'{}' is allowed to the right of a lane with '{}': their paths would cross",
                                            name_of(kFromTheLeft[b]), name_of(kFromTheLeft[a])));
                    return;
                }
            }
        }
        if (lanes.empty()) return;
        const int left = StreetLayout::left_pockets(leg.settings);
        const int through = StreetLayout::through_lanes(leg.settings);
        if (through == 0) {
            add_problem(leg.field + ".lanes",
                        "all lanes are pockets: at least one lane must be as long as the approach");
        }
        for (int k = left; k < left + through; ++k) {
            if (lanes[at(k)].pocket_m <= 0.0) continue;
            add_problem(fmt::format("{}.lanes[{}].pocket", leg.field, k),
                        "a pocket must lie to the left or to the right of all lanes that are as long as the approach");
            return;
        }
    }

    void check_width(const Leg& leg) {
        const char* const field = leg.side % 2 == 0 ? "median" : "minor_median";
        const double median_m = leg.side % 2 == 0 ? s_.median_m : s_.minor_median_m;
        const auto lanes = static_cast<int>(leg.settings.lanes.size());
        const int left = StreetLayout::left_pockets(leg.settings);
        if (left * s_.lane_width_m > median_m + kTolerance) {
            add_problem(
                leg.field + ".lanes",
                fmt::format(
                    "pockets on the left lie in the median, but their width, {} x {:g} m, exceeds {}, {:g} m; set "
                    "{} to at least {:g} m, or move the pockets to the right",
                    left, s_.lane_width_m, field, median_m, field, left * s_.lane_width_m));
        }
        const bool crossed = std::any_of(kTurns.begin(), kTurns.end(), [&](Turn turn) {
            return turn != Turn::straight && layout_.leg(leg.node, exit_side(leg.side, turn)) != nullptr;
        });
        const double half_m = 0.5 * median_m + std::max(lanes - left, leg.settings.exits) * s_.lane_width_m;
        const double radius_m = layout_.node(leg.node).radius_m;
        if (crossed && half_m + s_.clearance_m > radius_m + kTolerance) {
            add_problem(field_of(leg.node) + ".radius",
                        fmt::format("the lanes in the {} need a radius of at least {:g} m", leg.settings.from,
                                    half_m + s_.clearance_m));
        }
    }

    void check_turns(const Leg& leg) {
        const double right = leg.settings.right_share;
        const double left = leg.settings.left_share;
        if (right + left > 1.0 + kTolerance)
            return add_problem(leg.field + ".left", "left and right together exceed 100 %");
        if (leg.settings.lanes.empty()) return;
        for (const Turn turn : kTurns) {
            const double share = turn == Turn::right ? right : turn == Turn::left ? left : 1.0 - right - left;
            const std::vector<int> lanes = lanes_with(leg.settings, turn);
            const std::string field = leg.field + "." + (turn == Turn::straight ? "lanes" : name_of(turn));
            if (lanes.empty() && share > kTolerance) {
                add_problem(field, fmt::format("no lane allows '{}', but this is the movement of {:g} % of the traffic",
                                               name_of(turn), 100.0 * share));
            }
            if (lanes.empty()) continue;
            const int side = exit_side(leg.side, turn);
            const StreetLeg* const out = layout_.leg(leg.node, side);
            const int exits = out == nullptr ? 0 : out->exits;
            if (exits >= static_cast<int>(lanes.size())) continue;
            add_problem(fmt::format("{}.lanes[{}].movements", leg.field, lanes[0]),
                        fmt::format("{} lane{} '{}', but {} in the {}", lanes.size(),
                                    lanes.size() == 1 ? " leads" : "s lead", name_of(turn),
                                    exits == 0   ? "there is no exit"
                                    : exits == 1 ? "there is one exit"
                                                 : fmt::format("there are {} exits", exits),
                                    kSides[at(side)]));
        }
    }

    void check_roads(const Leg& leg) {
        const int nearest = layout_.nearest(leg.node, leg.side);
        if (nearest < 0) return;
        const StreetIntersection& other = layout_.node(nearest);
        const StreetLeg* const facing = layout_.leg(nearest, opposite(leg.side));
        const StreetIntersection& own = layout_.node(leg.node);
        if (facing == nullptr) {
            const double free_m = std::hypot(own.x_m - other.x_m, own.y_m - other.y_m) - own.radius_m - other.radius_m;
            if (std::max(leg.settings.length_m, leg.settings.exit_length_m) < free_m) return;
            return add_problem(leg.field + ".from", fmt::format("the leg reaches '{}', which has no leg in the {}",
                                                                other.name, kSides[at(opposite(leg.side))]));
        }
        const int through = StreetLayout::through_lanes(leg.settings);
        if (facing->exits > through) {
            add_problem(leg.field + ".lanes", fmt::format("{} exits of '{}' lead here, but only {} lanes continue them",
                                                          facing->exits, other.name, through));
        }
        if (through > 0 && facing->exits == 0) {
            add_problem(leg.field + ".lanes", fmt::format("no traffic reaches these lanes: '{}' has no exits in the {}",
                                                          other.name, kSides[at(opposite(leg.side))]));
        }
    }

    void check_pockets(const Leg& leg) {
        const double whole_m = layout_.length_m(leg.node, leg.side);
        for (std::size_t k = 0; k < leg.settings.lanes.size(); ++k) {
            if (leg.settings.lanes[k].pocket_m < whole_m) continue;
            add_problem(fmt::format("{}.lanes[{}].pocket", leg.field, k),
                        fmt::format("the pocket must be shorter than the approach of {:g} m", whole_m));
        }
    }

    const StreetSettings& s_;
    StreetLayout layout_;
    std::vector<StreetProblem> problems_;
};

}  // namespace

std::string clearance_problem(double clearance_m, double lane_width_m) {
    constexpr double kMargin_m = 0.5;
    const double max_m = lane_width_m - kMargin_m;
    if (clearance_m <= max_m + kTolerance) return "";
    return fmt::format(
        "value {:g} m is too large for lanes of {:g} m: vehicles on neighbouring lanes would touch. The maximum is "
        "{:g} m, which is {:g} m below lane_width",
        clearance_m, lane_width_m, max_m, kMargin_m);
}

std::vector<StreetProblem> street_problems(const StreetSettings& streets) { return Checks(streets).run(); }

}  // namespace stopline
