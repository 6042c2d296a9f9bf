// Tests of imported SUMO traffic: insertion positions, induction loops, and names in the output files.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "record/recording/recording_header.h"
#include "record/sumo_files.h"
#include "runs/network/network_run.h"
#include "scenario/import_sumo.h"
#include "scenario/load_scenario.h"
#include "support/sumo_files.h"

namespace stopline {
namespace {

using testing::crossing_net;
using testing::SumoFiles;

constexpr const char* kMeso = "fidelity: meso\n";
constexpr const char* kFull = "fidelity: full\nstep: 10 ms\n";

Scenario scenario_of(const std::string& routes, const std::string& loops = "", const std::string& fidelity = kMeso) {
    const SumoFiles files;
    files.write("my.net.xml", crossing_net());
    files.write("my.rou.xml", "<routes>\n" + routes + "\n</routes>");
    files.write("my.add.xml", "<additional>\n" + loops + "\n</additional>");
    return parse_scenario(
        fidelity +
            "duration: 200 s\n"
            "network: {kind: sumo, net: ./my.net.xml, routes: [./my.rou.xml], additional: [./my.add.xml]}\n"
            "populations: [CDG]\nmeasure: {window: 100 s}\n",
        "my.yaml", {}, files.folder());
}

std::size_t lane_named(const Model& model, const std::string& name) {
    const std::vector<Lane>& lanes = model.graph.lanes;
    const auto found = std::find_if(lanes.begin(), lanes.end(), [&](const Lane& lane) { return lane.name == name; });
    EXPECT_NE(found, lanes.end()) << name;
    return static_cast<std::size_t>(found - lanes.begin());
}

// Returns the front positions of the vehicles on a lane at a time, m.
std::vector<double> fronts_m(const Scenario& scenario, const std::string& lane, double time_s) {
    const Model model = network_model(scenario, 0);
    Simulation simulation(model);
    simulation.run_until(time_s);
    const State& state = simulation.state();
    const LaneBlock& block = state.blocks[lane_named(model, lane)];
    const auto first = state.vehicles.position_m.begin() + block.first;
    return {first, first + block.count};
}

TEST(SumoEntry, FollowsDepartPos) {
    const auto front_m = [](const std::string& position) {
        const std::vector<double> fronts = fronts_m(
            scenario_of("<trip id=\"a\" depart=\"0\" from=\"w_in\" to=\"e_out\" " + position + "/>"), "w_in_0", 0.1);
        EXPECT_EQ(fronts.size(), 1U) << position;
        return fronts.empty() ? -1.0 : fronts[0];
    };
    EXPECT_NEAR(front_m(""), 5.0, 0.3);
    EXPECT_NEAR(front_m("departPos=\"base\""), 5.0, 0.3);
    EXPECT_NEAR(front_m("departPos=\"60\""), 60.0, 0.3);
    // The rear lies upstream of the start of the edge. This is allowed, because no vehicle can come from behind.
    EXPECT_NEAR(front_m("departPos=\"2\""), 2.0, 0.3);
    EXPECT_NEAR(front_m("departPos=\"-40.5\""), 149.5, 0.3);
    EXPECT_GT(front_m("departPos=\"last\""), 180.0);
    EXPECT_NE(front_m("departPos=\"random\""), front_m(""));
}

TEST(SumoEntry, BetweenOtherVehiclesKeepsTheOrder) {
    for (const char* const fidelity : {kMeso, kFull}) {
        const Scenario scenario = scenario_of(R"(
<trip id="a" depart="0" from="w_in" to="e_out" departLane="0" departSpeed="0" departPos="40"/>
<trip id="b" depart="0" from="w_in" to="e_out" departLane="0" departSpeed="0" departPos="150"/>
<trip id="c" depart="1" from="w_in" to="e_out" departLane="0" departSpeed="0" departPos="100"/>)",
                                              "", fidelity);
        const std::vector<double> fronts = fronts_m(scenario, "w_in_0", 1.2);
        ASSERT_EQ(fronts.size(), 3U);
        EXPECT_NEAR(fronts[1], 100.0, 1.0);
        EXPECT_GT(fronts[0], 149.9);
        EXPECT_LT(fronts[2], 45.0);
        const NetworkResult result = run_network(scenario, 0, {}, 1, {});
        EXPECT_EQ(result.exited, 3) << fidelity;
        EXPECT_TRUE(result.violations.none()) << fidelity;
    }
}

TEST(SumoEntry, InDenseTrafficCausesNoViolation) {
    std::string routes;
    for (const char* const where : {"random", "free", "last", "120", "-30"}) {
        routes += std::string("<flow id=\"") + where + "\" begin=\"1\" end=\"100\" number=\"30\" from=\"w_in\" " +
                  "to=\"e_out\" departLane=\"random\" departSpeed=\"avg\" departPos=\"" + where + "\"/>\n";
    }
    for (const char* const fidelity : {kMeso, kFull}) {
        const NetworkResult result = run_network(scenario_of(routes, "", fidelity), 0, {}, 1, {});
        EXPECT_TRUE(result.violations.none()) << fidelity;
        EXPECT_EQ(result.entered + result.backlog, 150) << fidelity;
        EXPECT_EQ(result.exited, result.entered) << fidelity;
        EXPECT_GT(result.entered, 120) << fidelity;
    }
}

// Edge s is only 0.2 m long, so the rear of a vehicle inserted there reaches back into the junction. Vehicles from edge
// b drive through this junction at no more than 0.5 m/s.
TEST(SumoEntry, OnShortEdgesCausesNoViolation) {
    const SumoFiles files;
    files.write("my.net.xml", testing::replaced(testing::merge_net("0.2"), R"(:J_1_0" index="0" speed="13.89")",
                                                R"(:J_1_0" index="0" speed="0.5")"));
    files.write("my.rou.xml", R"(<routes><flow id="b" begin="0" end="600" period="20" from="b" to="c"/>
<flow id="s" begin="0" end="600" period="13" from="s" to="c"/></routes>)");
    const Scenario scenario = parse_scenario(
        std::string(kMeso) + "duration: 600 s\nnetwork: {kind: sumo, net: ./my.net.xml, routes: [./my.rou.xml]}\n" +
            "populations: [CTG-Ref]\nmeasure: {window: 300 s}\n",
        "my.yaml", {}, files.folder());
    const NetworkResult result = run_network(scenario, 0, {}, 1, {});
    EXPECT_TRUE(result.violations.none()) << result.violations.overlaps;
    EXPECT_GT(result.exited, 25);
}

// A yielding vehicle waits with its front give_way.margin_m upstream of the conflict area. The vehicle of this test
// enters on edge s, which is 2 m long. If a conflict area begins at the end of s, the vehicle must not be inserted
// beyond its waiting position.
TEST(SumoEntry, OnShortEdgesLeavesTheMarginForYielding) {
    const auto front_m = [](const std::string& position, const std::string& conflicting_shape) {
        const SumoFiles files;
        files.write("my.net.xml", testing::replaced(testing::roundabout_net(), "10,-8 14,0", conflicting_shape));
        files.write("my.rou.xml", "<routes><trip id=\"a\" depart=\"0\" departSpeed=\"0\" from=\"s\" to=\"c\" " +
                                      position + "/></routes>");
        const Scenario scenario = parse_scenario(
            std::string(kMeso) + "duration: 60 s\nnetwork: {kind: sumo, net: ./my.net.xml, routes: [./my.rou.xml]}\n" +
                "populations: [CTG-Ref]\nmeasure: {window: 60 s}\n",
            "my.yaml", {}, files.folder());
        const std::vector<double> fronts = fronts_m(scenario, "s_0", 0.1);
        EXPECT_EQ(fronts.size(), 1U) << position;
        return fronts.empty() ? -1.0 : fronts[0];
    };
    const double margin_m = network_model(scenario_of(R"(<trip id="a" depart="0" from="w_in" to="e_out"/>)"), 0)
                                .drivers[0]
                                .give_way.margin_m;
    ASSERT_GT(margin_m, 0.2);
    for (const char* const position : {"", "departPos=\"2\"", "departPos=\"last\""}) {
        EXPECT_NEAR(front_m(position, "10,-8 7,-0.5 14,0"), std::max(2.0 - margin_m, 0.0), 0.05) << position;
    }
    EXPECT_NEAR(front_m("departPos=\"2\"", "10,-8 14,0"), 2.0, 0.05);
}

TEST(SumoEntry, OnOneLaneDoesNotWaitForTheOtherLane) {
    // The right lane has no room behind a stopped vehicle near its start. The left lane is free.
    const std::string blocker = R"(<trip id="slow" depart="0" from="w_in" to="e_out" departPos="8" departSpeed="0"/>)";
    const std::string right =
        R"(<flow id="r" begin="0.1" end="0.2" number="12" from="w_in" to="e_out" departLane="0" departPos="8"/>)";
    const std::string left = R"(<trip id="l" depart="0.3" from="w_in" to="e_out" departLane="1" departSpeed="max"/>)";
    EXPECT_EQ(fronts_m(scenario_of(blocker + right + left), "w_in_1", 0.6).size(), 1U);
}

TEST(SumoLoops, CountPassingVehicles) {
    const std::string loops = R"(<inductionLoop id="far" lane="w_in_0" pos="-40" period="60" file="x.xml"/>
<e1Detector id="near &amp; dear" lane="w_in_0" pos="30" period="60" file="x.xml"/>
<e1Detector id="feet" lane="n_out_0" pos="30" period="60" file="x.xml"/>)";
    const Scenario scenario = scenario_of(R"(
<trip id="a" depart="0" from="w_in" to="e_out" departLane="0" departSpeed="max"/>
<trip id="b" depart="0" from="w_in" to="e_out" departLane="0" departPos="100" departSpeed="max"/>)",
                                          loops);
    EXPECT_EQ(testing::without_folder(sumo_warnings(scenario).back()),
              "my.add.xml:4: the detector is ignored: it lies inside a junction or on a lane closed to cars");
    Model model = network_model(scenario, 0);
    model.records_detectors = true;
    ASSERT_EQ(model.loop_names, (std::vector<std::string>{"far", "near & dear"}));
    Simulation simulation(model);
    simulation.run_until(60.0);
    std::vector<std::vector<double>> times(2);
    for (const Crossing& crossing : simulation.state().records.crossings) {
        const int loop = model.detectors[static_cast<std::size_t>(crossing.detector)].loop;
        if (loop >= 0) times[static_cast<std::size_t>(loop)].push_back(crossing.time_s);
    }
    ASSERT_EQ(times[0].size(), 2U);
    EXPECT_NEAR(times[0][0], 50.0 / 13.89, 0.3);
    EXPECT_NEAR(times[0][1], 145.0 / 13.89, 0.3);
    ASSERT_EQ(times[1].size(), 1U);  // vehicle b enters downstream of this loop
    EXPECT_NEAR(times[1][0], 25.0 / 13.89, 0.3);
}

TEST(SumoTables, UseTheNamesOfTheRouteFile) {
    const SumoFiles files;
    const Scenario scenario = scenario_of(R"(<trip id="a &amp; b" depart="0.25" from="w_in" to="e_out"/>)",
                                          R"(<e1Detector id="my loop" lane="w_in_0" pos="30" period="60" file="x"/>)");
    Model model = network_model(scenario, 0);
    model.records_detectors = true;
    const auto table_text = [&](const char* name, const auto& make) {
        const std::filesystem::path file = files.folder() / name;
        const std::unique_ptr<RunWriter> writer = make(file);
        Simulation simulation(model);
        for (writer->observe(simulation.state()); simulation.time_s() < 60.0; writer->observe(simulation.state()))
            simulation.step();
        writer->finish();
        std::ifstream stream(file);
        return std::string(std::istreambuf_iterator<char>(stream), {});
    };
    const std::string trips = table_text("t.xml", [&](auto& file) { return make_tripinfo_writer(file, model); });
    EXPECT_NE(trips.find("id=\"a &amp; b\" depart=\"0.30\""), std::string::npos) << trips;
    EXPECT_NE(trips.find("departDelay=\"0.00\""), std::string::npos) << trips;
    const std::string fcd = table_text("f.xml", [&](auto& file) { return make_fcd_writer(file, {}, model); });
    EXPECT_NE(fcd.find("vehicle id=\"a &amp; b\""), std::string::npos);
    EXPECT_NE(fcd.find("lane=\":J_1_0\""), std::string::npos);
    const std::string loops = table_text("l.xml", [&](auto& file) { return make_loop_writer(file, 60.0, model); });
    EXPECT_NE(loops.find("id=\"my loop\" nVehContrib=\"1\""), std::string::npos) << loops;
    EXPECT_NE(loops.find("id=\"w_in_0_stop_line\" nVehContrib=\"1\""), std::string::npos) << loops;
    EXPECT_EQ(loops.find("id=\"\""), std::string::npos) << loops;
}

TEST(SumoTables, RecordingsNameUnknownTurns) {
    Model model = network_model(scenario_of(R"(<trip id="a" depart="0" from="w_in" to="e_out"/>)"), 0);
    Lane& connection = model.graph.lanes[lane_named(model, ":J_1_0")];
    connection.turn = static_cast<Turn>(7);
    const std::string header = recording_header(model, {}, make_frame_grid(model, FrameClock({}, model.step_s)));
    EXPECT_NE(header.find("\"turn\":\"turn 7\""), std::string::npos) << header;
}

}  // namespace
}  // namespace stopline
