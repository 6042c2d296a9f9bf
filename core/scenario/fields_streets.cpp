// Fields of streets that a user describes (data/berlin/*.yaml).
#include <string>
#include <vector>

#include "network/street_checks.h"
#include "scenario/field_rows.h"
#include "scenario/fields.h"

namespace stopline {
namespace {

const Table& lane_table() {
    static const Table table = make_table<StreetLane>(
        "a lane to the intersection",
        {
            choice<&StreetLane::movements>("movements", lane_movements(), "where its vehicles may go").required(),
            number<&StreetLane::pocket_m>(
                "pocket", "m", {0, 1000},
                "how far before the stop line it begins: a vehicle and its standstill gap or more; 0 m: it is as long as the approach"),
        });
    return table;
}

const Table& arm_table() {
    using S = StreetArm;
    static const Table table = make_table<S>(
        "what an intersection has on one side",
        {
            choice<&S::from>("from", {"west", "south", "east", "north"}, "the side that its traffic comes from")
                .required(),
            list<&S::lanes>("lanes", lane_table, {0, 8}, "lanes to the intersection, from the left; none: a way out"),
            whole<&S::exits>("exits", {0, 8}, "lanes that lead away from the intersection on this side"),
            number<&S::speed_limit_mps>("speed_limit", "km/h", {5, 150}, "speed limit"),
            number<&S::right>("right", "%", {0, 100}, "of its traffic, turning right"),
            number<&S::left>("left", "%", {0, 100}, "of its traffic, turning left"),
            number<&S::length_m>("length", "m", {20, 20'000},
                                 "from the border of the network to the stop line, where the arm does not come from "
                                 "another intersection"),
            number<&S::exit_length_m>("exit_length", "m", {20, 20'000},
                                      "from the intersection to the border, likewise"),
        });
    return table;
}

const Table& programme_table() {
    using S = SevenSteps;
    static const Table table = make_table<S>(
        "the signal programme, in the order of its steps; major is the street from west to east",
        {
            number<&S::major_green_s>("major_green", "s", {0, 600}, "green of the major street"),
            number<&S::major_yellow_s>("major_yellow", "s", {0, 60}, "its yellow"),
            number<&S::major_clearance_s>("major_clearance", "s", {0, 600}, "all red"),
            number<&S::protected_left_s>("protected_left", "s", {0, 600},
                                         "green of lanes of the major street that only turn left; 0 s: none"),
            number<&S::minor_green_s>("minor_green", "s", {0, 600}, "green of the minor street"),
            number<&S::minor_yellow_s>("minor_yellow", "s", {0, 60}, "its yellow"),
            number<&S::minor_clearance_s>("minor_clearance", "s", {0, 600}, "all red"),
        });
    return table;
}

const Table& node_table() {
    using S = StreetIntersection;
    static const Table table = make_table<S>(
        "an intersection",
        {
            text<&S::name>("name", TextField::Rule::name, "names of its lanes begin with it").required(),
            number<&S::x_m>("x", "m", {-1'000'000, 1'000'000}, "its centre, to the east"),
            number<&S::y_m>("y", "m", {-1'000'000, 1'000'000}, "and to the north"),
            number<&S::radius_m>("radius", "m", {3, 100}, "from the centre to the stop lines"),
            list<&S::arms>("arms", arm_table, {2, 4}, "its arms; two that face each other: a pedestrian light")
                .required(),
            section<&S::programme>("programme", programme_table, "the seven steps of its signals"),
            number<&S::offset_s>("offset", "s", {0, 7200}, "when the major street's green begins, in every cycle"),
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
        "streets with intersections; arms of two that face each other on one line are the ends of one road",
        {
            text<&S::name>("name", TextField::Rule::name, "name of the network"),
            number<&S::median_m>("median", "m", {0, 50}, "between the directions of streets from west to east"),
            number<&S::minor_median_m>("minor_median", "m", {0, 50}, "and of those from south to north"),
            number<&S::lane_width_m>("lane_width", "m", {2, 6}, "width of a lane"),
            number<&S::turn_speed_mps>("turn_speed", "m/s", {1, 40}, "speed on turning paths"),
            number<&S::clearance_m>(
                "clearance", "m", {1, 5},
                "vehicles whose centre lines are nearer than this touch; 0.5 m below lane_width or less"),
            list<&S::intersections>("intersections", node_table, {1, 1000}, "the intersections").required(),
        },
        [](const S& streets, Checker& check) {
            for (const StreetProblem& problem : street_problems(streets)) check.error(problem.field, problem.message);
        });
    return table;
}

}  // namespace stopline
