// Tests of streets from a file: values of the shipped network, checks and messages.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "scenario/scenario_text.h"

namespace stopline {
namespace {

const char* const kStreets = R"(median: 4 m
intersections:
- name: first
  legs:
  - {from: west, lanes: &three [{movements: straight+left}, {movements: straight}, {movements: straight+right}], exits: 3, right: 12 %, left: 8 %}
  - {from: east, lanes: *three, exits: 3, right: 12 %, left: 8 %}
  - {from: south, lanes: [{movements: straight+left+right}], exits: 1}
  - {from: north, lanes: [{movements: straight+left+right}], exits: 1}
- name: second
  x: 200 m
  legs:
  - {from: west, lanes: &straight [{movements: straight}, {movements: straight}, {movements: straight}], exits: 3}
  - {from: east, lanes: *straight, exits: 3}
)";

// Loads a scenario with a network file in the same folder.
Scenario load(const std::string& streets, const std::vector<std::string>& overrides = {}) {
    const TemporaryFolder folder;
    folder.write("my_streets.yaml", streets);
    const auto file = folder.write("s.yaml", "network: {kind: streets, streets: ./my_streets.yaml}\n");
    return load_scenario(file, overrides);
}

std::string error_with(const std::string& from, const std::string& to, const std::vector<std::string>& overrides = {}) {
    std::string text = kStreets;
    text.replace(text.find(from), from.size(), to);
    return input_error_of([&] { load(text, overrides); });
}

TEST(Streets, AreReadFromAUserFile) {
    const Scenario s = load(kStreets, {"network.streets.intersections[second].offset=42 s"});
    const StreetSettings& streets = s.network.streets;
    EXPECT_EQ(streets.name, "my_streets");
    ASSERT_EQ(streets.intersections.size(), 2u);
    EXPECT_EQ(streets.intersections[1].offset_s, 42.0);
    EXPECT_EQ(streets.intersections[0].legs[1].lanes[2].movements, "straight+right");
    EXPECT_EQ(streets.intersections[0].legs[1].right_share, 0.12);
    EXPECT_EQ(s.nominal_cycle().cycle_s, 60.0);
}

TEST(Streets, ReadBackFromTheirCanonicalText) {
    const Scenario s = load_scenario(shipped("scenarios/berlin.yaml"));
    const std::string text = canonical_text(s);
    EXPECT_EQ(text.find("\nsignal:"), std::string::npos);
    const Scenario reread = parse_scenario(text, "back.yaml");
    EXPECT_EQ(canonical_text(reread), text);
    EXPECT_EQ(reread.hash, s.hash);
}

TEST(Streets, ProblemsNameFileLineAndField) {
    EXPECT_TRUE(contains(error_with("left: 8 %", "left: 90 %"),
                         "my_streets.yaml:5:143: field 'network.streets.intersections[first].legs[0].left': left and "
                         "right together exceed 100 %"));
    EXPECT_TRUE(contains(
        error_with("x: 200 m", "x: 30 m"),
        "my_streets.yaml:10:6: field 'network.streets.intersections[second].x': the centre is only 30 m from"));
    EXPECT_TRUE(contains(error_with("movements: straight+left}", "movements: straight+left, pocket: 60}"),
                         "lanes[0].pocket': value '60' has no unit"));
    EXPECT_TRUE(contains(error_with("median: 4 m", "median: 4 m\nclearance: 5 m"),
                         "my_streets.yaml:2:12: field 'network.streets.clearance': value 5 m is too large for lanes of "
                         "3.5 m: vehicles on neighbouring lanes would touch. The maximum is 3 m"));
    EXPECT_TRUE(contains(error_with("from: west", "from: left"), "value 'left' is unknown"));
    EXPECT_TRUE(
        contains(error_with("x: 200 m", "offset: 1 s\n  radius: 2 m"), "is out of range (allowed: 3 m to 100 m)"));
    EXPECT_TRUE(contains(error_of("network: {kind: streets}\n"), "field 'network.streets' is missing"));
    EXPECT_TRUE(contains(error_of("network: {kind: streets, streets: four}\n"), "there is no 'four'"));
    EXPECT_TRUE(contains(error_of("network: {kind: streets, streets: four}\n"), "four_lanes"));
}

TEST(Streets, PocketsAreAsLongAsAVehicleAndItsGap) {
    const std::string west = "{movements: straight+left}, {movements: straight}, ";
    const auto with = [&](const std::string& pocket) {
        return error_with(west,
                          "{movements: left, pocket: " + pocket + "}, {movements: straight}, {movements: straight}, ",
                          {"populations=[CDG]"});
    };
    EXPECT_TRUE(contains(
        with("1 m"),
        "my_streets.yaml:5:59: field 'network.streets.intersections[first].legs[0].lanes[0].pocket': value 1 m "
        "is too short for a vehicle of 5.15 m and its standstill gap: at least 8.1 m, or 0 m"));
    EXPECT_TRUE(contains(with("8 m"), "value 8 m is too short"));
    EXPECT_EQ(with("8.1 m"), "");
}

TEST(Streets, HaveTheirOwnSignalsAndTurns) {
    const auto with = [](const std::vector<std::string>& overrides) {
        return input_error_of([&] { load(kStreets, overrides); });
    };
    EXPECT_EQ(with({}), "");
    EXPECT_TRUE(contains(with({"signal.green=20 s"}),
                         "field 'signal.green': has no effect on streets: the programmes of network.streets have"));
    EXPECT_TRUE(contains(with({"demand.left=5 %"}), "field 'demand.left': has no effect on streets"));
    EXPECT_TRUE(
        contains(with({"demand.cross_turns=separate"}), "field 'demand.cross_turns': has no effect on streets"));
    EXPECT_TRUE(contains(with({"demand={kind: rate, inflow: 600 veh/h}"}), "field 'demand.kind': "));
    EXPECT_TRUE(
        contains(with({"demand={kind: saturated, cross_inflow: 600 veh/h}"}), "field 'demand.cross_inflow': is for"));
    EXPECT_TRUE(contains(with({"network.streets.intersections[first].offset=0.005 s"}), "not a whole number of steps"));
}

TEST(Streets, CanHaveActuatedSignals) {
    const auto with = [](const std::vector<std::string>& overrides) {
        return input_error_of([&] { load(kStreets, overrides); });
    };
    const std::string actuated = "signal.controller=actuated";
    EXPECT_EQ(with({actuated, "signal.stop_detector=2 m", "signal.advance_detector=0 m"}), "");
    for (const std::string name : {"dual_ring", "external"}) {
        EXPECT_TRUE(contains(with({"signal.controller=" + name}),
                             "field 'signal.controller': '" + name +
                                 "' cannot run the programmes of streets (allowed: fixed_time, actuated)"));
    }
    EXPECT_TRUE(contains(with({"signal.stop_detector=2 m"}), "'signal.stop_detector' applies only if controller is"));
    for (const std::string time : {"first_green", "green", "cross_green", "yellow", "all_red", "offset", "cycle"}) {
        EXPECT_TRUE(contains(with({actuated, "signal." + time + "=77 s"}),
                             "field 'signal." + time + "': has no effect on streets"));
    }
    EXPECT_TRUE(contains(with({actuated, "signal.phases=[{protected: [west_left], green: 8 s}]"}),
                         "field 'signal.phases': is not for streets, whose phases follow from"));
    EXPECT_TRUE(contains(with({actuated,
                               "network.streets.intersections[first].programme={major_green: 36 s, "
                               "minor_green: 0 s}"}),
                         "field 'network.streets.intersections[first].programme.minor_green': 0 s gives this street no "
                         "green"));
}

TEST(Streets, ActuatedSignalsReadBackFromTheirCanonicalText) {
    const Scenario s = load_scenario(shipped("scenarios/berlin.yaml"), {"signal.controller=actuated"});
    const std::string text = canonical_text(s);
    EXPECT_TRUE(contains(text, "  controller: actuated"));
    const Scenario reread = parse_scenario(text, "back.yaml");
    EXPECT_EQ(canonical_text(reread), text);
    EXPECT_NE(s.hash, load_scenario(shipped("scenarios/berlin.yaml")).hash);
}

// Compares with the rows of Table 3 in the paper: the seven steps of the signal programme, its offset, and the turn
// shares of the major and the minor street.
TEST(Berlin, MatchesTable3) {
    struct Row {
        const char* name;
        std::array<double, 7> steps_s;
        double offset_s;
        double right;
        double left;
        double minor_right;
        double minor_left;
    };
    const std::array<Row, 10> rows{{
        {"koenigin_elisabeth_str", {22, 3, 8, 3, 11, 3, 10}, 54, 0.12, 0.08, 0.3, 0.3},
        {"sophie_charlotte_str", {24, 3, 9, 0, 12, 3, 9}, 19, 0.12, 0.08, 0.3, 0.2},
        {"witzlebenplatz", {27, 3, 9, 0, 9, 3, 9}, 31, 0.12, 0.0, 1.0, 0.0},
        {"suarezstr", {24, 3, 9, 0, 12, 3, 9}, 55, 0.12, 0.08, 0.16, 0.09},
        {"kaiser_friedrich_str", {28, 3, 9, 0, 8, 3, 9}, 32, 0.12, 0.08, 0.13, 0.12},
        {"wilmersdorfer_str", {23, 3, 9, 0, 13, 3, 9}, 46, 0.12, 0.08, 0.16, 0.09},
        {"krumme_str", {24, 3, 9, 0, 12, 3, 9}, 31, 0.12, 0.08, 0.16, 0.09},
        {"pedestrian_lights", {29, 3, 9, 0, 7, 3, 9}, 42, 0.0, 0.0, 0.0, 0.0},
        {"leibnizstr", {22, 3, 9, 0, 14, 3, 9}, 5, 0.12, 0.08, 0.3, 0.2},
        {"am_schillertheater", {27, 3, 9, 0, 9, 3, 9}, 0, 0.12, 0.0, 1.0, 0.0},
    }};
    for (const char* const network : {"three_lanes", "four_lanes"}) {
        const Scenario s = load_scenario(shipped("scenarios/berlin.yaml"), {std::string("network.streets=") + network});
        const auto& nodes = s.network.streets.intersections;
        ASSERT_EQ(nodes.size(), rows.size());
        for (std::size_t k = 0; k < rows.size(); ++k) {
            EXPECT_EQ(nodes[k].name, rows[k].name);
            EXPECT_EQ(nodes[k].programme.steps_s(), rows[k].steps_s) << rows[k].name;
            EXPECT_EQ(nodes[k].programme.cycle_s(), 60.0) << rows[k].name;
            EXPECT_EQ(nodes[k].offset_s, rows[k].offset_s) << rows[k].name;
            for (const StreetLeg& leg : nodes[k].legs) {
                const bool major = leg.from == "west" || leg.from == "east";
                EXPECT_EQ(leg.right_share, major ? rows[k].right : rows[k].minor_right) << rows[k].name;
                EXPECT_EQ(leg.left_share, major ? rows[k].left : rows[k].minor_left) << rows[k].name;
                if (major) {
                    EXPECT_EQ(leg.exits, std::string(network) == "three_lanes" ? 3 : 4) << rows[k].name;
                }
            }
        }
    }
}

// Compares the distances between neighbouring intersections with Table 3. The positions in the streets file are from
// OpenStreetMap, so the distances differ by up to 5 m from the table.
TEST(Berlin, HasTheDistancesOfTable3) {
    constexpr std::array<double, 9> kTable_m{500, 160, 390, 290, 250, 280, 160, 210, 160};
    const Scenario s = load_scenario(shipped("scenarios/berlin.yaml"));
    const auto& nodes = s.network.streets.intersections;
    for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
        EXPECT_NEAR(nodes[k + 1].x_m - nodes[k].x_m, kTable_m[k], 5.0) << nodes[k].name;
    }
}

}  // namespace
}  // namespace stopline
