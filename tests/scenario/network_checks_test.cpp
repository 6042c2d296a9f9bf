// Tests of the checks of network, signal, demand, rules and measurement. Each message names the field to change.
#include <gtest/gtest.h>

#include "scenario/scenario_text.h"

namespace stopline {
namespace {

std::string error_for_kind(const std::string& kind, const std::vector<std::string>& overrides) {
    return error_of("network: {kind: " + kind + "}\nduration: 600 s\n", overrides);
}

std::string error_in_grid(std::vector<std::string> overrides) {
    overrides.insert(overrides.begin(), {"network.grid.columns=3", "network.grid.rows=3"});
    return error_for_kind("grid", overrides);
}

// The default vehicle is 5.15 m long, its gap in the default populations is up to 6 m, and it stops from 50 km/h in
// 31.4 m.
TEST(GridLinks, AreLongEnoughForAVehicleAndForStopping) {
    EXPECT_EQ(error_in_grid({}), "");
    EXPECT_TRUE(contains(error_in_grid({"network.grid.column_spacing=50 m", "network.intersection.radius=30 m"}),
                         "field 'network.grid.column_spacing': value 50 m leaves -10 m of road between intersections "
                         "of network.intersection.radius = 30 m: at least 91.4 m with this radius"));
    EXPECT_TRUE(contains(error_in_grid({"network.intersection.radius=100 m"}),
                         "field 'network.grid.row_spacing': value 192.5 m leaves -7.5 m of road"));
    EXPECT_TRUE(contains(error_in_grid({"network.intersection.radius=95 m"}),
                         "value 192.5 m leaves 2.5 m of road between intersections of network.intersection.radius = "
                         "95 m: at least 221.4 m with this radius, as a vehicle with its gap needs 11.15 m, and "
                         "31.4 m to stop from 50 km/h at 3.5 m/s2 (driver.stop.decision_deceleration)"));
    EXPECT_EQ(error_in_grid({"network.grid.row_spacing=71.4 m"}), "");
    EXPECT_TRUE(contains(error_in_grid({"network.grid.row_spacing=71.3 m"}), "network.grid.row_spacing"));
    const std::vector<std::string> slow{"network.intersection.speed_limit=10 km/h"};
    EXPECT_EQ(error_in_grid({slow[0], "network.grid.row_spacing=51.15 m"}), "");
    EXPECT_TRUE(
        contains(error_in_grid({slow[0], "network.grid.row_spacing=51.1 m"}), "at least 51.15 m with this radius"));
    // With one row, no street from south to north joins two intersections.
    EXPECT_EQ(error_in_grid({"network.grid.rows=1", "network.grid.row_spacing=50 m"}), "");
}

TEST(StreetLinks, AreLongEnoughForAVehicleAndForStopping) {
    const auto error = [](const std::string& limit) {
        return error_of("network: {kind: streets, streets: three_lanes}\n",
                        {"network.streets.intersections[pedestrian_lights].legs[0].speed_limit=" + limit});
    };
    EXPECT_EQ(error("50 km/h"), "");
    EXPECT_TRUE(
        contains(error("150 km/h"),
                 "field 'network.streets.intersections[pedestrian_lights].x': leaves 135 m of road from "
                 "'krumme_str' to the stop line: at least 259.3 m, as a vehicle with its gap needs 11.15 m, and "
                 "259.3 m to stop from 150 km/h at 3.5 m/s2 (driver.stop.decision_deceleration); or give this "
                 "leg a lower speed_limit"));
}

TEST(Entries, VehiclesCanStopBeforeTheLine) {
    const std::vector<std::string> fast{"network.intersection.speed_limit=150 km/h", "demand.entry_speed=150 km/h"};
    EXPECT_TRUE(
        contains(error_for_kind("intersection", {fast[0], fast[1], "network.intersection.approach_length=50 m"}),
                 "field 'network.intersection.approach_length': value 50 m is too short to stop from 150 km/h "
                 "at 3.5 m/s2 (driver.stop.decision_deceleration) before the stop line: at least 259.3 m, or a "
                 "lower demand.entry_speed than 150 km/h"));
    EXPECT_EQ(error_for_kind("intersection", {fast[0], fast[1], "network.intersection.approach_length=259.3 m"}), "");
    // With the default speed limit, vehicles enter at 50 km/h despite the entry speed of 150 km/h, so 50 m suffice.
    EXPECT_EQ(error_for_kind("intersection", {fast[1], "network.intersection.approach_length=50 m"}), "");
    EXPECT_TRUE(contains(error_of("demand: {vehicles: 1}\n", {"network.approach.length=30 m"}),
                         "field 'network.approach.length': value 30 m is too short to stop from 50 km/h"));
    EXPECT_TRUE(contains(error_of("network: {kind: streets, streets: three_lanes}\n",
                                  {"network.streets.intersections[sophie_charlotte_str].legs[2].length=20 m"}),
                         "field 'network.streets.intersections[sophie_charlotte_str].legs[2].length': value 20 m"));
}

TEST(MeasuredArea, EndsWithinTheNetwork) {
    EXPECT_EQ(error_in_grid({"measure.area_margin=100 m"}), "");
    EXPECT_TRUE(
        contains(error_in_grid({"measure.area_margin=100.1 m"}),
                 "field 'measure.area_margin': value 100.1 m reaches beyond the end of the network: at most 100 m, "
                 "the value of network.intersection.exit_length"));
    EXPECT_TRUE(contains(error_in_grid({"measure.area_margin=500 m", "network.intersection.exit_length=600 m"}),
                         "at most 200 m, the value of network.intersection.approach_length"));
    const std::string streets = "network: {kind: streets, streets: three_lanes}\n";
    EXPECT_EQ(error_of(streets, {"measure.area_margin=100 m"}), "");
    EXPECT_TRUE(contains(
        error_of(streets, {"measure.area_margin=101 m"}),
        "at most 100 m, the value of network.streets.intersections[koenigin_elisabeth_str].legs[0].exit_length"));
}

TEST(Cycle, OfAnIntersectionFollowsFromItsStages) {
    for (const char* const kind : {"intersection", "grid"}) {
        EXPECT_TRUE(contains(
            error_for_kind(kind, {"signal.cycle=200 s", "signal.cross_green=10 s"}),
            "field 'signal.cycle': must be left out here: it follows from green, cross_green, yellow and all_red, 86 s"));
    }
}

std::string error_with_lanes(const std::string& kind, const std::string& lanes,
                             const std::vector<std::string>& overrides) {
    return error_of("network: {kind: " + kind + ", intersection: {lanes: [" + lanes + "]}}\nduration: 600 s\n",
                    overrides);
}

TEST(Turns, OfALaneSumToAtMost100Percent) {
    for (const char* const kind : {"intersection", "grid"}) {
        const std::string all = "{movements: straight+left+right}";
        EXPECT_TRUE(contains(error_with_lanes(kind, all, {"demand.left=60 %", "demand.right=60 %"}),
                             "field 'demand.left': left and right sum to 120 % on a lane 'straight+left+right' "
                             "(allowed: at most 100 %)"));
        EXPECT_EQ(error_with_lanes(kind, all, {"demand.left=60 %", "demand.right=40 %"}), "");
        EXPECT_TRUE(contains(
            error_with_lanes(kind, all,
                             {"demand.cross_turns=separate", "demand.cross_left=60 %", "demand.cross_right=60 %"}),
            "field 'demand.cross_left': cross_left and cross_right sum to 120 %"));
        // The sum is limited only on a lane that allows both turns, and the default network has no such lane.
        EXPECT_EQ(error_for_kind(kind, {"demand.left=60 %", "demand.right=60 %"}), "");
    }
}

TEST(Turns, NeedALaneThatServesThem) {
    for (const char* const kind : {"intersection", "grid"}) {
        const std::string two = "{movements: straight}, {movements: straight}";
        EXPECT_TRUE(contains(error_with_lanes(kind, two, {"demand.left=50 %"}),
                             "field 'demand.left': value 50 % has no effect: network.intersection.lanes has no lane "
                             "that allows left and another movement"));
        const std::string left_lane = "{movements: left}, {movements: straight+right}";
        EXPECT_TRUE(contains(error_with_lanes(kind, left_lane, {"demand.left=50 %"}), "has no effect"));
        EXPECT_EQ(error_with_lanes(kind, left_lane, {"demand.right=50 %"}), "");
        EXPECT_TRUE(contains(error_with_lanes(kind, two, {"demand.cross_turns=separate", "demand.cross_right=5 %"}),
                             "field 'demand.cross_right': value 5 % has no effect"));
        const std::string turns_only = "{movements: left+right}";
        EXPECT_TRUE(
            contains(error_with_lanes(kind, turns_only, {}),
                     "field 'demand.left': left and right are 0 %, but all vehicles turn on a lane 'left+right'"));
        EXPECT_EQ(error_with_lanes(kind, turns_only, {"demand.left=60 %"}), "");
    }
    EXPECT_TRUE(contains(error_of("title: x\n", {"demand.right=5 %"}), "has no effect on a straight road"));
}

std::string error_with_rules(const std::string& rules, const std::vector<std::string>& overrides = {}) {
    return error_of("rules: " + rules + "\n", overrides);
}

TEST(Rules, ParametersOfKeepClearNeedTheRule) {
    EXPECT_TRUE(contains(error_with_rules("{keep_clear: off, count_queue_at_red_exit: on}"),
                         "test.yaml:1:51: field 'rules.count_queue_at_red_exit' applies only if keep_clear is on"));
    EXPECT_TRUE(contains(error_with_rules("{keep_clear: off, sight: 100 m}"), "'rules.sight' applies only if"));
    EXPECT_TRUE(contains(error_with_rules("{keep_clear: off}", {"rules.count_queue_at_red_exit=on"}),
                         "'rules.count_queue_at_red_exit' applies only if"));
    EXPECT_TRUE(contains(error_with_rules("{keep_clear: off}", {"rules.sight=9 m"}), "'rules.sight' applies only if"));
    EXPECT_TRUE(
        contains(error_with_rules("{}", {"rules={keep_clear: off, count_queue_at_red_exit: on}"}), "applies only if"));
    EXPECT_TRUE(contains(error_with_rules("{sight: off}"), "field 'rules.sight': value 'off' is not a number"));
    for (const char* const rules :
         {"{}", "{teleport_cycles: 3}", "{sight: 300 m}", "{count_queue_at_red_exit: on}", "{keep_clear: on}",
          "{keep_clear: on, count_queue_at_red_exit: on}", "{count_queue_at_red_exit: off}",
          "{keep_clear: on, sight: 100 m, count_queue_at_red_exit: off}",
          "{keep_clear: off, count_queue_at_red_exit: off}"}) {
        EXPECT_EQ(error_with_rules(rules), "") << rules;
    }
}

// If an override switches the keep-clear rule off, the file may still set parameters of this rule. An override may not.
TEST(Rules, CanBeSwitchedOffByOneOverride) {
    const std::string all = "{keep_clear: on, sight: 100 m, count_queue_at_red_exit: on}";
    EXPECT_EQ(error_with_rules(all, {"rules.keep_clear=off"}), "");
    EXPECT_TRUE(contains(error_with_rules(all, {"rules.keep_clear=off", "rules.count_queue_at_red_exit=on"}),
                         "applies only if"));
    EXPECT_TRUE(
        contains(error_with_rules("{keep_clear: on, sight: 0 m}", {"rules.keep_clear=off"}), "is out of range"));
    for (const char* const keep_clear : {"on", "off"}) {
        const Scenario scenario =
            parse_scenario("rules: " + all + "\n", "test.yaml", {std::string("rules.keep_clear=") + keep_clear});
        const std::string text = canonical_text(scenario);
        EXPECT_EQ(canonical_text(parse_scenario(text, "test.yaml")), text) << keep_clear;
        EXPECT_EQ(text.find("count_queue_at_red_exit") != std::string::npos, std::string(keep_clear) == "on");
    }
}

TEST(DemandApproaches, ExistInTheNetwork) {
    EXPECT_EQ(error_in_grid({"demand.approaches=[c0r0_west, c1r1_south_in, c2r2]"}), "");
    const std::string known =
        "Known: c0r0_west, c0r0_south, c1r0_south, c2r0_south, c2r0_east, c0r1_west, c2r1_east, c0r2_west, "
        "c0r2_north, c1r2_north, c2r2_east, c2r2_north and 24 more";
    EXPECT_TRUE(contains(error_in_grid({"demand.approaches=[c0r0_west, c0r0_wst]"}),
                         "field 'demand.approaches[1]': no approach lane has a name that begins with 'c0r0_wst_'; did "
                         "you mean 'c0r0_west'? " +
                             known));
    EXPECT_TRUE(contains(error_in_grid({"demand.approaches=[c9]"}), "begins with 'c9_'; known: c0r0_west"));
    EXPECT_TRUE(contains(error_for_kind("intersection", {"demand.approaches=[up]"}),
                         "begins with 'up_'; known: west, south, east, north"));
    EXPECT_TRUE(
        contains(error_of("network: {kind: streets, streets: three_lanes}\n", {"demand.approaches=[suarezstr_up]"}),
                 "field 'demand.approaches[0]': no approach lane"));
}

TEST(Seconds, AreWholeNumbersOfStepsAndIntervalsOfSeconds) {
    EXPECT_TRUE(contains(error_in_grid({"measure.interval=7.5 s"}),
                         "field 'measure.interval': value 7.5 s is not a whole number of seconds"));
    const std::vector<std::string> even{"signal={first_green: 2.4 s, green: 20 s, yellow: 4 s, all_red: 4 s}"};
    const std::string meso = "meso={base: passages, step: ";
    EXPECT_TRUE(
        contains(error_in_grid({"fidelity=meso", meso + "0.4 s}", even[0]}),
                 "field 'meso.step': vehicles are counted every second, but 1 s is not a whole number of steps of "
                 "400 ms"));
    EXPECT_EQ(error_in_grid({"fidelity=meso", meso + "0.2 s}", even[0]}), "");
    EXPECT_EQ(error_for_kind("intersection", {"fidelity=meso", meso + "0.4 s}", even[0]}), "") << "no series";
}

TEST(TimeSpace, IsForGridsAndStreets) {
    for (const char* const kind : {"approach", "intersection"}) {
        EXPECT_TRUE(contains(error_for_kind(kind, {"measure.time_space=60 s"}),
                             "field 'measure.time_space': is for grids and streets"));
    }
}

TEST(TimeSpace, SideNeedsADiagram) {
    EXPECT_TRUE(contains(error_in_grid({"measure.time_space_side=south"}),
                         "field 'measure.time_space_side': value south has no effect without measure.time_space"));
    EXPECT_EQ(error_in_grid({"measure.time_space_side=south", "measure.time_space=60 s"}), "");
    EXPECT_EQ(error_in_grid({"measure.time_space_side=west"}), "");
    EXPECT_TRUE(contains(error_in_grid({"measure.time_space_side=up", "measure.time_space=60 s"}), "'up' is unknown"));
}

TEST(StringStability, IsForSingleLights) {
    EXPECT_TRUE(contains(error_for_kind("intersection", {"measure.string_stability=on"}),
                         "field 'measure.string_stability': is for a single light only"));
    EXPECT_EQ(error_for_kind("approach", {"measure.string_stability=on"}), "");
}

// A vehicle at rest occupies the road from 1 m before the stop line (driver.stop.margin) to its length further
// upstream.
TEST(StopDetector, LiesBelowTheFirstVehicleOfAQueue) {
    const std::string actuated =
        "signal.phases=[{protected: [west_straight, east_straight], green: 10 s}, "
        "{protected: [south_straight, north_straight], green: 10 s}]";
    const auto error = [&](const std::vector<std::string>& settings) {
        std::vector<std::string> overrides{"network.intersection.lanes=[{movements: straight}]", actuated,
                                           "signal.controller=actuated"};
        overrides.insert(overrides.end(), settings.begin(), settings.end());
        return error_for_kind("intersection", overrides);
    };
    EXPECT_EQ(error({}), "");
    EXPECT_EQ(error({"signal.stop_detector=1 m"}), "");
    EXPECT_EQ(error({"signal.stop_detector=6.1 m"}), "");
    EXPECT_TRUE(
        contains(error({"signal.stop_detector=6.2 m"}),
                 "field 'signal.stop_detector': value 6.2 m: a vehicle that waits at the stop line is not on the "
                 "detector and gets no green. For a vehicle of 5.15 m with driver.stop.margin = 1 m, give 1 m "
                 "to 6.15 m"));
    EXPECT_TRUE(contains(error({"signal.stop_detector=0.9 m"}), "give 1 m to 6.15 m"));
    EXPECT_TRUE(contains(error({"vehicle.length=0.5 m"}), "For a vehicle of 0.5 m"));
    EXPECT_TRUE(contains(error({"driver.stop.margin=4 m"}), "with driver.stop.margin = 4 m"));
    // The controller fixed_time has no detectors.
    EXPECT_EQ(error({"signal.controller=fixed_time", "vehicle.length=0.5 m"}), "");
}

}  // namespace
}  // namespace stopline
