// Tests of exported networks: SUMO's plain network, signals, routes, and summaries of runs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <sstream>

#include "base/containers/index.h"
#include "base/input_error.h"
#include "base/io/output.h"
#include "scenario/build_model.h"
#include "scenario/load_scenario.h"
#include "scenario/scenario_text.h"
#include "signals/signal_controller.h"
#include "sim/step/simulation.h"
#include "sumo_export/edges.h"
#include "sumo_export/export.h"
#include "sumo_export/facts.h"
#include "sumo_export/inputs.h"
#include "sumo_import/sumo_xml.h"

namespace stopline {
namespace {

Model model_of(const std::string& scenario, std::vector<std::string> overrides = {}) {
    overrides.emplace_back("fidelity=meso");
    return build_model(load_scenario(STOPLINE_SOURCE_DIR "/scenarios/" + scenario, overrides), 0);
}

std::string first_word(const std::string& text) { return text.substr(0, text.find(' ')); }

Model small_grid() { return model_of("grid.yaml", {"network.grid.columns=2", "network.grid.rows=3"}); }

TEST(PlainNetwork, ListsEachEdgeLaneOnceFromTheRight) {
    const Model model = small_grid();
    const PlainNetwork network = plain_network(model.graph);
    std::set<int> listed;
    for (std::size_t k = 0; k < network.edges.size(); ++k) {
        const PlainEdge& edge = network.edges[k];
        for (std::size_t i = 0; i < edge.lanes.size(); ++i) {
            EXPECT_TRUE(listed.insert(edge.lanes[i]).second);
            ASSERT_EQ(network.parts_of[at(edge.lanes[i])].size(), 1U);
            const EdgePart& part = network.parts_of[at(edge.lanes[i])][0];
            EXPECT_EQ(part.edge, static_cast<int>(k));
            EXPECT_EQ(part.index, static_cast<int>(i));
            EXPECT_EQ(part.from_m, 0.0);
            const Lane& lane = model.graph.lanes[at(edge.lanes[i])];
            if (i == 0) continue;
            // The previous lane lies to the right: the cross product with the direction of travel is negative.
            const Pose here = pose_at(lane.shape, 1.0);
            const Point previous_point = pose_at(model.graph.lanes[at(edge.lanes[i - 1])].shape, 1.0).point;
            EXPECT_LT(
                here.cosine * (previous_point.y_m - here.point.y_m) - here.sine * (previous_point.x_m - here.point.x_m),
                -1.0);
        }
    }
    const auto edge_lanes = std::count_if(model.graph.lanes.begin(), model.graph.lanes.end(),
                                          [](const Lane& lane) { return lane.origin < 0; });
    EXPECT_EQ(listed.size(), static_cast<std::size_t>(edge_lanes));
}

TEST(PlainNetwork, HasANodeForEachIntersectionAndStreetEnd) {
    const Model model = small_grid();
    const PlainNetwork network = plain_network(model.graph);
    const auto signals = std::count_if(network.nodes.begin(), network.nodes.end(),
                                       [](const PlainNode& node) { return node.has_signal; });
    EXPECT_EQ(signals, 6);
    // Ten streets lead out of 2 x 3 intersections. Each has an inward and an outward edge with separate outer nodes.
    EXPECT_EQ(network.nodes.size(), 6U + 2U * 10U);
}

TEST(PlainNetwork, ConnectionsKeepTheirLength) {
    const Model model = small_grid();
    const PlainNetwork network = plain_network(model.graph);
    std::size_t connection_count = 0;
    for (const PlainConnection& c : network.connections) {
        ASSERT_GE(c.connection_lane, 0);
        const Lane& connection = model.graph.lanes[at(c.connection_lane)];
        const Lane& from = model.graph.lanes[at(c.from)];
        EXPECT_EQ(connection.origin, c.from);
        EXPECT_EQ(connection.next.front(), c.to);
        EXPECT_NEAR(c.length_m, from.length_m - from.stop_line_m + connection.length_m, 1e-9);
        EXPECT_GE(c.link, 0);
        ++connection_count;
    }
    EXPECT_EQ(connection_count,
              static_cast<std::size_t>(std::count_if(model.graph.lanes.begin(), model.graph.lanes.end(),
                                                     [](const Lane& lane) { return lane.origin >= 0; })));
}

TEST(SumoExport, RefusesImportedNetworks) {
    Scenario scenario = load_scenario(STOPLINE_SOURCE_DIR "/scenarios/single_light.yaml", {});
    EXPECT_NO_THROW(check_exportable(scenario));
    scenario.network.kind = "sumo";
    EXPECT_THROW(check_exportable(scenario), InputError);
}

TEST(SumoExport, NotesTheLimitsOfSumo) {
    const Scenario scenario = load_scenario(STOPLINE_SOURCE_DIR "/scenarios/single_light.yaml", {"fidelity=meso"});
    for (std::size_t k = 0; k < scenario.populations.size(); ++k) {
        const bool has_note = !sumo_limits_note(build_model(scenario, k)).empty();
        const std::string& name = scenario.populations[k].name;
        EXPECT_EQ(has_note, name.rfind("CTG", 0) != 0) << name;
    }
}

// Every link has a letter in every phase, and the phases add up to the cycle.
TEST(SumoInputs, SignalsMatchTheModel) {
    const Model model = small_grid();
    const PlainNetwork network = plain_network(model.graph);
    const TemporaryFolder folder;
    write_sumo_inputs(folder.path(), model, network, 600.0);
    const SumoXml xml(folder.path() / "lights.tll.xml", {"tlLogics"});
    std::size_t programmes = 0;
    for (const pugi::xml_node logic : xml.root().children("tlLogic")) {
        ++programmes;
        double from_s = 0.0;
        for (const pugi::xml_node phase : logic.children("phase")) {
            const std::string letters = xml.text(phase, "state");
            const double duration_s = xml.number(phase, "duration");
            for (const PlainConnection& c : network.connections) {
                if (network.nodes[at(c.node)].id != xml.text(logic, "id")) continue;
                ASSERT_LT(at(c.link), letters.size());
                const int group = model.graph.lanes[at(c.from)].signal_group;
                const Light light =
                    model.signals.programme(group).light(to_ticks(from_s + 0.5 * duration_s, model.step_s));
                const char letter = letters[at(c.link)];
                EXPECT_EQ(light == Light::green, letter == 'G' || letter == 'g');
                EXPECT_EQ(light == Light::yellow, letter == 'y');
                const Turn turn = model.graph.lanes[at(c.connection_lane)].turn;
                EXPECT_FALSE(letter == 'g' && turn == Turn::straight);
                EXPECT_FALSE(letter == 'G' && turn == Turn::left);
            }
            from_s += duration_s;
        }
        EXPECT_NEAR(from_s, model.time_s(model.signals.programme(0).cycle_ticks()), 1e-6);
    }
    EXPECT_EQ(programmes, 6U);
}

TEST(SumoInputs, SignalsThatReactToTrafficAreRefused) {
    Model model = small_grid();
    SignalController controller = find_signal_controller("fixed_time");
    controller.follows_programme = false;
    SignalPlans signals;
    for (SignalPlan plan : model.signals) {
        plan.controller = &controller;
        signals.add(plan);
    }
    model.signals = signals;
    const TemporaryFolder folder;
    EXPECT_THROW(write_sumo_inputs(folder.path(), model, plain_network(model.graph), 600.0), InputError);
}

// The programme has one green only and does not repeat, so its phases cover the whole run.
TEST(SumoInputs, ProgrammesWithoutRepetitionCoverTheRun) {
    const Model model = model_of("single_light.yaml");
    const TemporaryFolder folder;
    write_sumo_inputs(folder.path(), model, plain_network(model.graph), 500.0);
    const SumoXml xml(folder.path() / "lights.tll.xml", {"tlLogics"});
    double total_s = 0.0;
    double green_s = 0.0;
    for (const pugi::xml_node phase : xml.root().child("tlLogic").children("phase")) {
        total_s += xml.number(phase, "duration");
        if (xml.text(phase, "state")[0] == 'G') green_s += xml.number(phase, "duration");
    }
    EXPECT_NEAR(total_s, 500.0, 1e-6);
    double expected_s = 0.0;
    for (std::int64_t tick = 0; tick < to_ticks(500.0, model.step_s); ++tick) {
        if (model.signals.programme(0).light(tick) == Light::green) expected_s += model.step_s;
    }
    EXPECT_GT(green_s, 0.0);
    EXPECT_NEAR(green_s, expected_s, 1e-6);
}

// Successive edges of a route are connected, also on routes of vehicles that were teleported over several edges.
TEST(SumoInputs, RoutesAreConnected) {
    const Model model = model_of(
        "grid.yaml", {"network.grid.columns=3", "network.grid.rows=3", "network.grid.column_spacing=150 m",
                      "network.grid.row_spacing=150 m", "network.intersection.approach_length=150 m",
                      "demand.left=15 %", "signal.green=20 s", "rules.keep_clear=off", "rules.teleport_cycles=1"});
    const PlainNetwork network = plain_network(model.graph);
    std::set<std::pair<std::string, std::string>> connected;
    for (const PlainConnection& c : network.connections) {
        connected.emplace(network.edges[at(c.begin.edge)].id, network.edges[at(c.end.edge)].id);
    }
    const TemporaryFolder folder;
    const auto writer = make_sumo_route_writer(folder.path() / "v.rou.xml", model, network);
    Simulation simulation(model);
    while (simulation.time_s() < 900.0) {
        writer->observe(simulation.state());
        simulation.step();
    }
    writer->finish();
    ASSERT_GT(simulation.state().congestion.delays.teleported, 5);

    const SumoXml xml(folder.path() / "v.rou.xml", {"routes"});
    int vehicles = 0;
    for (const pugi::xml_node vehicle : xml.root().children("vehicle")) {
        ++vehicles;
        std::istringstream edges(xml.text(vehicle.child("route"), "edges"));
        std::string from;
        edges >> from;
        for (std::string to; edges >> to; from = to) EXPECT_TRUE(connected.count({from, to})) << from << " " << to;
    }
    EXPECT_GT(vehicles, 500);
}

// SUMO inserts a vehicle only if the free space ahead exceeds the minGap of its type.
TEST(SumoInputs, InitialQueuesKeepTheGapsOfTheirTypes) {
    for (const char* const name : {"intersection.yaml", "calibration.yaml"}) {
        const Model model = model_of(name);
        const PlainNetwork network = plain_network(model.graph);
        const TemporaryFolder folder;
        const auto writer = make_sumo_route_writer(folder.path() / "v.rou.xml", model, network);
        const Simulation simulation(model);
        writer->observe(simulation.state());
        writer->finish();

        const SumoXml xml(folder.path() / "v.rou.xml", {"routes"});
        std::map<std::string, double> gap_m;  // by type
        std::map<std::string, double> length_m;
        for (const pugi::xml_node type : xml.root().children("vType")) {
            length_m[xml.text(type, "id")] = xml.number(type, "length");
            gap_m[xml.text(type, "id")] = xml.number(type, "minGap");
        }
        std::map<std::string, std::map<double, std::string>> lanes;  // types by lane and position
        for (const pugi::xml_node vehicle : xml.root().children("vehicle")) {
            const std::string edge = first_word(xml.text(vehicle.child("route"), "edges"));
            lanes[edge + "_" + xml.text(vehicle, "departLane")][xml.number(vehicle, "departPos")] =
                xml.text(vehicle, "type");
        }
        int pairs = 0;
        for (const auto& [lane, queue] : lanes) {
            for (auto follower = queue.begin(); std::next(follower) != queue.end(); ++follower) {
                const auto leader = std::next(follower);
                const double free_m = leader->first - length_m[leader->second] - follower->first;
                EXPECT_GT(free_m - gap_m[follower->second], 0.0005) << name << " " << lane;
                EXPECT_LT(free_m - gap_m[follower->second], 0.0015) << name << " " << lane;
                ++pairs;
            }
        }
        EXPECT_GT(pairs, 5) << name;
    }
}

TEST(RunSummary, CoversTheTimeWindow) {
    RunFacts facts;
    facts.trips = {{10.0, 99.0, 0.0}, {110.0, 30.0, 2.0}, {200.0, 50.0, 4.0}, {201.0, 99.0, 9.0}};
    facts.passed_s["a_0"] = {99.0, 101.0, 150.0};
    facts.passed_s["a_1"] = {102.0};
    facts.instants = {{100.0, 5, 5, 0.0}, {101.0, 4, 2, 8.0}, {102.0, 4, 1, 10.0}};
    const RunSummary sum = summary_of(facts, 100.0, 200.0);
    EXPECT_DOUBLE_EQ(sum.throughput_veh_h, 72.0);
    EXPECT_DOUBLE_EQ(sum.travel_time_s, 40.0);
    EXPECT_DOUBLE_EQ(sum.departure_delay_s, 3.0);
    EXPECT_DOUBLE_EQ(sum.passages_veh_h, 108.0);
    EXPECT_DOUBLE_EQ(sum.speed_mps, 9.0);
    EXPECT_DOUBLE_EQ(sum.stopped, 1.5);
    EXPECT_TRUE(std::isnan(summary_of(facts, 300.0, 400.0).travel_time_s));
}

// SUMO writes meanSpeed="-1.00" for a step without vehicles.
TEST(RunSummary, MeanSpeedIgnoresStepsWithoutVehicles) {
    const TemporaryFolder folder;
    write_file(folder.path() / "trips.out.xml", "<tripinfos/>");
    write_file(folder.path() / "detectors.out.xml", "<instantE1/>");
    write_file(
        folder.path() / "summary.out.xml",
        "<summary><step time=\"1\" running=\"2\" halting=\"1\" meanSpeed=\"6.00\" waiting=\"0\" teleports=\"0\"/>"
        "<step time=\"2\" running=\"0\" halting=\"0\" meanSpeed=\"-1.00\" waiting=\"4\" teleports=\"2\"/></summary>");
    const RunFacts facts = read_sumo_facts(folder.path(), true);
    const RunSummary sum = summary_of(facts, 0.0, 2.0);
    EXPECT_DOUBLE_EQ(sum.speed_mps, 6.0);
    EXPECT_DOUBLE_EQ(sum.stopped, 0.5);
    EXPECT_DOUBLE_EQ(sum.backlog, 4.0);
    EXPECT_EQ(facts.teleported, 2);
    EXPECT_TRUE(std::isnan(summary_of(facts, 1.0, 2.0).speed_mps));
}

}  // namespace
}  // namespace stopline
