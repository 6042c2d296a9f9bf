#include "network/street_checks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "network/street_layout.h"

namespace stopline {

namespace {

constexpr double kShortestLink_m = 10.0;  // longer than a vehicle
constexpr double kTiny = 1e-9;

std::size_t at(int index) { return static_cast<std::size_t>(index); }

class Checks {
public:
    explicit Checks(const StreetSettings& streets) : s_(streets), layout_(streets) {}

    std::vector<StreetProblem> run() {
        const std::string touching = clearance_problem(s_.clearance_m, s_.lane_width_m);
        if (!touching.empty()) problem("clearance", touching);
        for (int n = 0; n < layout_.nodes(); ++n) {
            name_and_sides(n);
            programme(n);
        }
        if (problems_.empty()) places();
        if (problems_.empty()) each_arm(&Checks::order_of_lanes);
        if (problems_.empty()) each_arm(&Checks::width);
        if (problems_.empty()) each_arm(&Checks::turns);
        if (problems_.empty()) each_arm(&Checks::joins);
        if (problems_.empty()) each_arm(&Checks::pockets);
        return std::move(problems_);
    }

private:
    struct Arm {
        int node;
        int side;
        const StreetArm& settings;
        std::string field;
    };

    void problem(std::string field, std::string message) {
        problems_.push_back({std::move(field), std::move(message)});
    }
    std::string field_of(int n) const { return fmt::format("intersections[{}]", layout_.node(n).name); }

    void each_arm(void (Checks::*look)(const Arm&)) {
        for (int n = 0; n < layout_.nodes(); ++n) {
            const StreetIntersection& node = layout_.node(n);
            for (std::size_t a = 0; a < node.arms.size(); ++a) {
                const auto* const side = std::find(kSides.begin(), kSides.end(), node.arms[a].from);
                (this->*look)({n, static_cast<int>(side - kSides.begin()), node.arms[a],
                               fmt::format("{}.arms[{}]", field_of(n), a)});
            }
        }
    }

    void name_and_sides(int n) {
        const StreetIntersection& node = layout_.node(n);
        for (int other = 0; other < n; ++other) {
            if (layout_.node(other).name != node.name) continue;
            problem(field_of(n) + ".name", fmt::format("the name '{}' appears twice", node.name));
        }
        if (node.arms.size() < 2) problem(field_of(n) + ".arms", "at least two arms are needed");
        for (std::size_t a = 0; a < node.arms.size(); ++a) {
            const std::string field = fmt::format("{}.arms[{}].from", field_of(n), a);
            const std::string& from = node.arms[a].from;
            if (std::find(kSides.begin(), kSides.end(), from) == kSides.end()) {
                problem(field, fmt::format("there is no side '{}'", from));
            }
            for (std::size_t b = 0; b < a; ++b) {
                if (node.arms[b].from == from) problem(field, fmt::format("a second arm in the {}", from));
            }
        }
    }

    void programme(int n) {
        const SevenSteps& own = layout_.node(n).programme;
        const StreetIntersection& first = layout_.node(0);
        const std::string field = field_of(n) + ".programme";
        if (std::abs(own.cycle_s() - first.programme.cycle_s()) > kTiny) {
            problem(field,
                    fmt::format("its seven steps sum to a cycle of {:g} s, those of '{}' to {:g} s: offsets need "
                                "the same cycle everywhere",
                                own.cycle_s(), first.name, first.programme.cycle_s()));
        }
        if (own.major_green_s <= 0.0) problem(field + ".major_green", "the major street needs a green");
        const auto leads_in = [&](int side) {
            return layout_.arm(n, side) != nullptr && !layout_.arm(n, side)->lanes.empty();
        };
        if (own.minor_green_s <= 0.0 && (leads_in(1) || leads_in(3))) {
            problem(field + ".minor_green", "the arms in the south and north need a green");
        }
    }

    void places() {
        for (int n = 0; n < layout_.nodes(); ++n) {
            for (int other = 0; other < n; ++other) {
                const StreetIntersection& a = layout_.node(n);
                const StreetIntersection& b = layout_.node(other);
                const double apart_m = std::hypot(a.x_m - b.x_m, a.y_m - b.y_m);
                if (apart_m >= a.radius_m + b.radius_m + kShortestLink_m) continue;
                problem(field_of(n) + ".x",
                        fmt::format("only {:g} m from '{}': their radii and {:g} m of road between them need {:g} m",
                                    apart_m, b.name, kShortestLink_m, a.radius_m + b.radius_m + kShortestLink_m));
            }
        }
    }

    // From the left: left turns, straight on, right turns; or ways of the same approach would cross.
    void order_of_lanes(const Arm& arm) {
        const auto& lanes = arm.settings.lanes;
        for (std::size_t k = 1; k < lanes.size(); ++k) {
            constexpr std::array<Turn, 3> kFromTheLeft{Turn::left, Turn::straight, Turn::right};
            for (std::size_t a = 0; a < kFromTheLeft.size(); ++a) {
                for (std::size_t b = 0; b < a; ++b) {
                    if (!allows(lanes[k - 1], kFromTheLeft[a]) || !allows(lanes[k], kFromTheLeft[b])) continue;
                    problem(fmt::format("{}.lanes[{}].movements", arm.field, k),
                            fmt::format("'{}' from the right of a lane that leads '{}': their ways would cross",
                                        name_of(kFromTheLeft[b]), name_of(kFromTheLeft[a])));
                    return;
                }
            }
        }
        if (lanes.empty()) return;
        const int left = StreetLayout::left_pockets(arm.settings);
        const int through = StreetLayout::through_lanes(arm.settings);
        if (through == 0) problem(arm.field + ".lanes", "one lane at least must be as long as the approach");
        for (int k = left; k < left + through; ++k) {
            if (lanes[at(k)].pocket_m <= 0.0) continue;
            problem(fmt::format("{}.lanes[{}].pocket", arm.field, k),
                    "pockets lie to the left or to the right of all lanes that are as long as the approach");
            return;
        }
    }

    void width(const Arm& arm) {
        const double median_m = arm.side % 2 == 0 ? s_.median_m : s_.minor_median_m;
        const auto lanes = static_cast<int>(arm.settings.lanes.size());
        const int left = StreetLayout::left_pockets(arm.settings);
        if (left * s_.lane_width_m > median_m + kTiny) {
            problem(arm.field + ".lanes",
                    fmt::format("pockets on the left lie in the median: {} of {:g} m do not fit into its {:g} m", left,
                                s_.lane_width_m, median_m));
        }
        const bool crossed = std::any_of(kTurns.begin(), kTurns.end(), [&](Turn turn) {
            return turn != Turn::straight && layout_.arm(arm.node, side_after(arm.side, turn)) != nullptr;
        });
        const double half_m = 0.5 * median_m + std::max(lanes - left, arm.settings.exits) * s_.lane_width_m;
        const double radius_m = layout_.node(arm.node).radius_m;
        if (crossed && half_m + s_.clearance_m > radius_m + kTiny) {
            problem(field_of(arm.node) + ".radius", fmt::format("the lanes in the {} need at least {:g} m",
                                                                arm.settings.from, half_m + s_.clearance_m));
        }
    }

    void turns(const Arm& arm) {
        const StreetArm& a = arm.settings;
        if (a.right + a.left > 1.0 + kTiny) return problem(arm.field + ".left", "left and right exceed 100 %");
        if (a.lanes.empty()) return;
        for (const Turn turn : kTurns) {
            const double share = turn == Turn::right ? a.right : turn == Turn::left ? a.left : 1.0 - a.right - a.left;
            const std::vector<int> lanes = lanes_with(a, turn);
            const std::string field = arm.field + "." + (turn == Turn::straight ? "lanes" : name_of(turn));
            if (lanes.empty() && share > kTiny) {
                problem(field, fmt::format("no lane allows the movement '{}' of {:g} % of the traffic", name_of(turn),
                                           100.0 * share));
            }
            if (lanes.empty()) continue;
            const int side = side_after(arm.side, turn);
            const StreetArm* const out = layout_.arm(arm.node, side);
            const int exits = out == nullptr ? 0 : out->exits;
            if (exits >= static_cast<int>(lanes.size())) continue;
            problem(fmt::format("{}.lanes[{}].movements", arm.field, lanes[0]),
                    fmt::format("{} lane{} '{}', but {} in the {}", lanes.size(),
                                lanes.size() == 1 ? " leads" : "s lead", name_of(turn),
                                exits == 0   ? "there is no exit"
                                : exits == 1 ? "there is one exit"
                                             : fmt::format("there are {} exits", exits),
                                kSides[at(side)]));
        }
    }

    void joins(const Arm& arm) {
        const int nearest = layout_.nearest(arm.node, arm.side);
        if (nearest < 0) return;
        const StreetIntersection& other = layout_.node(nearest);
        const StreetArm* const facing = layout_.arm(nearest, opposite(arm.side));
        const StreetIntersection& own = layout_.node(arm.node);
        if (facing == nullptr) {
            const double free_m = std::hypot(own.x_m - other.x_m, own.y_m - other.y_m) - own.radius_m - other.radius_m;
            if (std::max(arm.settings.length_m, arm.settings.exit_length_m) < free_m) return;
            return problem(arm.field + ".from", fmt::format("runs into '{}', which has no arm in the {}", other.name,
                                                            kSides[at(opposite(arm.side))]));
        }
        const int through = StreetLayout::through_lanes(arm.settings);
        if (facing->exits > through) {
            problem(arm.field + ".lanes", fmt::format("{} exits of '{}' lead here, but only {} lanes go on",
                                                      facing->exits, other.name, through));
        }
        if (through > 0 && facing->exits == 0) {
            problem(arm.field + ".lanes", fmt::format("nothing leads here: '{}' has no exits in the {}", other.name,
                                                      kSides[at(opposite(arm.side))]));
        }
    }

    void pockets(const Arm& arm) {
        const double whole_m = layout_.length_m(arm.node, arm.side);
        for (std::size_t k = 0; k < arm.settings.lanes.size(); ++k) {
            if (arm.settings.lanes[k].pocket_m < whole_m) continue;
            problem(fmt::format("{}.lanes[{}].pocket", arm.field, k),
                    fmt::format("must be shorter than the approach of {:g} m", whole_m));
        }
    }

    const StreetSettings& s_;
    StreetLayout layout_;
    std::vector<StreetProblem> problems_;
};

}  // namespace

std::string clearance_problem(double clearance_m, double lane_width_m) {
    constexpr double kMargin_m = 0.5;
    const double most_m = lane_width_m - kMargin_m;
    if (clearance_m <= most_m + kTiny) return "";
    return fmt::format(
        "value {:g} m is too large for lanes of {:g} m, vehicles on neighbouring lanes would touch: at most {:g} m, "
        "which is {:g} m below lane_width",
        clearance_m, lane_width_m, most_m, kMargin_m);
}

std::vector<StreetProblem> street_problems(const StreetSettings& streets) { return Checks(streets).run(); }

}  // namespace stopline
