// Fields of a network of streets (data/berlin/*.yaml).
#include <string>
#include <vector>

#include "network/generators/street_checks.h"
#include "scenario/schema/field_rows.h"
#include "scenario/schema/fields.h"

namespace stopline {
namespace {

const Table& lane_table() {
    static const Table table = make_table<StreetLane>(
        "an approach lane",
        {
            choice<&StreetLane::movements>("movements", lane_movements(),
                                           "movements that the lane allows, in any order")
                .required(),
            number<&StreetLane::pocket_m>(
                "pocket", "m", {0, 1000},
                "length of a turning pocket before the stop line, at least vehicle length + standstill gap; 0 m: no "
                "pocket, the lane is as long as the approach"),
        });
    return table;
}

const Table& leg_table() {
    using S = StreetLeg;
    static const Table table = make_table<S>(
        "a leg: the approach lanes and exit lanes on one side of an intersection",
        {
            choice<&S::from>("from", {"west", "south", "east", "north"}, "side from which the traffic comes")
                .required(),
            list<&S::lanes>("lanes", lane_table, {0, 8},
                            "approach lanes, from left to right; empty: the leg has exit lanes only"),
            whole_number<&S::exits>("exits", {0, 8}, "number of exit lanes on this side"),
            number<&S::speed_limit_mps>("speed_limit", "km/h", {5, 150}, "speed limit"),
            number<&S::right_share>("right", "%", {0, 100},
                                    "share of right turns; vehicles that turn neither right nor left go straight on"),
            number<&S::left_share>("left", "%", {0, 100}, "share of left turns"),
            number<&S::length_m>(
                "length", "m", {20, 20'000},
                "distance from the border of the network to the stop line, for a leg without neighbouring "
                "intersection"),
            number<&S::exit_length_m>(
                "exit_length", "m", {20, 20'000},
                "distance from the intersection to the border of the network, for a leg without neighbouring "
                "intersection"),
        });
    return table;
}

const Table& programme_table() {
    using S = SevenSteps;
    static const Table table = make_table<S>(
        "the signal programme: seven steps in this order; the major street runs from west to east",
        {
            number<&S::major_green_s>("major_green", "s", {0, 600}, "green of the major street"),
            number<&S::major_yellow_s>("major_yellow", "s", {0, 60}, "yellow of the major street"),
            number<&S::major_clearance_s>("major_clearance", "s", {0, 600}, "all-red time after major_yellow"),
            number<&S::protected_left_s>("protected_left", "s", {0, 600},
                                         "protected green of the left-turn lanes of the major street; 0 s: none"),
            number<&S::minor_green_s>("minor_green", "s", {0, 600}, "green of the minor street"),
            number<&S::minor_yellow_s>("minor_yellow", "s", {0, 60}, "yellow of the minor street"),
            number<&S::minor_clearance_s>("minor_clearance", "s", {0, 600}, "all-red time after minor_yellow"),
        });
    return table;
}

const Table& node_table() {
    using S = StreetIntersection;
    static const Table table = make_table<S>(
        "an intersection",
        {
            text<&S::name>("name", TextField::Rule::name,
                           "name of the intersection; the names of its lanes begin with it")
                .required(),
            number<&S::x_m>("x", "m", {-1'000'000, 1'000'000}, "position of the centre, eastwards"),
            number<&S::y_m>("y", "m", {-1'000'000, 1'000'000}, "position of the centre, northwards"),
            number<&S::radius_m>("radius", "m", {3, 100}, "distance from the centre to the stop lines"),
            list<&S::legs>("legs", leg_table, {2, 4},
                           "legs; an intersection with only two opposite legs is a pedestrian signal")
                .required()
                .renamed_from("arms"),
            section<&S::programme>("programme", programme_table, "signal programme of seven steps"),
            number<&S::offset_s>("offset", "s", {0, 7200}, "start of the major street's green within each cycle"),
        });
    return table;
}

}  // namespace

const std::vector<std::string>& lane_movements() {
    static const std::vector<std::string> names{
        "straight", "left", "right", "straight+left", "straight+right", "left+right", "straight+left+right"};
    return names;
}

const Table& streets_table() {
    using S = StreetSettings;
    static const Table table = make_table<S>(
        "streets with signalised intersections; two facing legs on one line are the ends of one road",
        {
            text<&S::name>("name", TextField::Rule::name, "name of the network"),
            number<&S::median_m>("median", "m", {0, 50}, "width of the median of streets from west to east"),
            number<&S::minor_median_m>("minor_median", "m", {0, 50},
                                       "width of the median of streets from south to north"),
            number<&S::lane_width_m>("lane_width", "m", {2, 6}, "width of a lane"),
            number<&S::turn_speed_mps>("turn_speed", "m/s", {1, 40}, "speed on turning connections"),
            number<&S::clearance_m>(
                "clearance", "m", {1, 5},
                "two vehicles touch if their centre lines are nearer than this; at most lane_width - 0.5 m"),
            number<&S::passing_clearance_m>(
                "passing_clearance", "m", {0, 6},
                "smallest distance between the paths at which a vehicle passes a vehicle from its own lane with "
                "another movement, such as a waiting left turner; from clearance to lane_width; 0 m: clearance"),
            list<&S::intersections>("intersections", node_table, {1, 1000}, "intersections").required(),
        },
        [](const S& streets, Checker& check) {
            for (const StreetProblem& problem : street_problems(streets)) check.error(problem.field, problem.message);
        });
    return table;
}

}  // namespace stopline
