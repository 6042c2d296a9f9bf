// Runs of small imported networks. Most of these networks are written by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "runs/network/network.h"
#include "runs/network/network_run.h"
#include "scenario/import_sumo.h"
#include "scenario/load_scenario.h"
#include "sim/perception/look_ahead.h"
#include "support/sumo_files.h"

namespace stopline {
namespace {

using testing::crossing_net;
using testing::signal_net;
using testing::SumoFiles;
using testing::two_phases;

Scenario scenario_of(const std::string& net, const std::string& routes,
                     const std::string& settings = "fidelity: meso\n") {
    const SumoFiles files;
    files.write("my.net.xml", net);
    files.write("my.rou.xml", "<routes>\n" + routes + "\n</routes>");
    return parse_scenario(settings +
                              "duration: 300 s\n"
                              "network: {kind: sumo, net: ./my.net.xml, routes: [./my.rou.xml]}\n"
                              "populations: [CDG, CTG-Ref]\nmeasure: {window: 200 s}\n",
                          "my.yaml", {}, files.folder());
}

constexpr const char* kBusyRoutes =
    R"(<flow id="w" from="w_in" to="e_out" vehsPerHour="700" end="200" departLane="best" departSpeed="max"/>
<flow id="l" from="w_in" to="n_out" vehsPerHour="200" end="200" departLane="best" departSpeed="max"/>
<flow id="s" from="s_in" to="n_out" vehsPerHour="400" end="200" departSpeed="max"/>)";

struct Case {
    const char* name;
    std::string net;
};

TEST(SumoRun, AllVehiclesExitWithoutViolationInBothFidelities) {
    for (const Case& network : {Case{"priority", crossing_net()}, Case{"lights", signal_net(two_phases())}}) {
        for (const char* const fidelity : {"fidelity: meso\n", "fidelity: full\nstep: 10 ms\n"}) {
            const Scenario scenario = scenario_of(network.net, kBusyRoutes, fidelity);
            for (std::size_t population = 0; population < 2; ++population) {
                const NetworkResult f = run_network(scenario, population, {}, 1, {});
                EXPECT_TRUE(f.violations.none()) << network.name << fidelity << population;
                EXPECT_EQ(f.violations.conflicts + f.violations.overlaps + f.violations.lost_vehicles, 0);
                EXPECT_EQ(f.entered, 39 + 12 + 23) << network.name << fidelity;
                EXPECT_EQ(f.exited, f.entered) << network.name << fidelity << population;
                EXPECT_EQ(f.missed_turns, 0);
                EXPECT_EQ(f.backlog, 0);
            }
        }
    }
}

TEST(SumoRun, ThreadsAndScalarKernelsGiveTheSameBits) {
    const Scenario scenario = scenario_of(signal_net(two_phases()), kBusyRoutes);
    const std::uint64_t one = run_network(scenario, 0, {}, 1, {}).state_hash;
    EXPECT_EQ(run_network(scenario, 0, {}, 3, {}).state_hash, one);
    Model model = network_model(scenario, 0);
    model.scalar_kernels = true;
    Simulation scalar(model);
    scalar.run_until(scenario.duration_s);
    EXPECT_EQ(scalar.state_hash(), one);
}

// Returns the time at which the first vehicle is on a lane; -1: none until `until_s`.
double first_arrival_s(const Scenario& scenario, const std::string& lane, double until_s) {
    const Model model = network_model(scenario, 0);
    Simulation simulation(model);
    while (simulation.time_s() < until_s) {
        simulation.step();
        for (std::size_t k = 0; k < model.graph.lanes.size(); ++k) {
            if (model.graph.lanes[k].name == lane && simulation.state().blocks[k].count > 0) return simulation.time_s();
        }
    }
    return -1.0;
}

TEST(SumoRun, RightOfWayFollowsTheRequestMatrix) {
    const std::string stream =
        R"(<flow id="w" from="w_in" to="e_out" period="2.5" end="90" departLane="0" departSpeed="max"/>)";
    const std::string minor = R"(<trip id="s" from="s_in" to="n_out" depart="20" departSpeed="max"/>)";
    const double alone_s = first_arrival_s(scenario_of(crossing_net(), minor), "n_out_1", 150.0);
    EXPECT_NEAR(alone_s, 20.0 + 205.0 / 13.89, 3.0);
    EXPECT_GT(first_arrival_s(scenario_of(crossing_net(), stream + minor), "n_out_1", 150.0), 95.0);
    // SUMO's request matrix (the `response` attributes) says which link yields to which. Reversed, it makes the major
    // stream yield.
    std::string reversed =
        testing::replaced(crossing_net(), "index=\"0\" response=\"1110\"", "index=\"0\" response=\"0000\"");
    reversed = testing::replaced(reversed, "index=\"1\" response=\"0000\"", "index=\"1\" response=\"0001\"");
    EXPECT_LT(first_arrival_s(scenario_of(reversed, stream + minor), "n_out_1", 150.0), alone_s + 5.0);
}

TEST(SumoRun, MovementsOfOneLaneObeyTheirOwnSignals) {
    // On the left lane the straight movement has green until 60 s, the left turn only after that.
    const std::string net = signal_net(
        R"(<phase duration="60" state="rGGr"/><phase duration="4" state="ryyr"/><phase duration="56" state="rrrG"/>)");
    const std::string straight = R"(<trip id="a" depart="0" from="w_in" to="e_out" departLane="1" departSpeed="max"/>)";
    const std::string left = R"(<trip id="b" depart="0" from="w_in" to="n_out" departLane="1" departSpeed="max"/>)";
    EXPECT_LT(first_arrival_s(scenario_of(net, straight), "e_out_1", 100.0), 25.0);
    const double turned_s = first_arrival_s(scenario_of(net, left), ":J_3_0", 100.0);
    EXPECT_GT(turned_s, 64.0);
    EXPECT_LT(turned_s, 70.0);
}

TEST(SumoRun, VehicleExitsAtTheEndOfItsRouteDespiteRed) {
    const std::string net = signal_net(R"(<phase duration="290" state="rrrr"/><phase duration="10" state="GGGG"/>)");
    const Scenario scenario =
        scenario_of(net, R"(<vehicle id="a" depart="0" departSpeed="max"><route edges="s_in"/></vehicle>
<vehicle id="b" depart="5" departSpeed="max"><route edges="s_in n_out"/></vehicle>)");
    const NetworkResult f = run_network(scenario, 0, {}, 1, {});
    EXPECT_EQ(f.entered, 2);
    EXPECT_EQ(f.exited, 1);
    EXPECT_TRUE(f.violations.none());
}

// A truck on an edge that is shorter than the truck still occupies the connection to this edge. Vehicles that yield to
// this connection must wait until the rear of the truck has left it.
TEST(SumoRun, VehiclesYieldAcrossShortEdges) {
    const std::string traffic =
        R"(<vType id="truck" length="12"/>
<flow id="b" from="b" to="c" period="7" end="200" type="truck" departSpeed="max"/>
<flow id="a" from="a" to="c" vehsPerHour="700" end="200" departSpeed="max"/>)";
    for (const char* const edge_m : {"0.5", "4", "20"}) {
        const Scenario scenario = scenario_of(testing::merge_net(edge_m), traffic);
        for (std::size_t population = 0; population < 2; ++population) {
            const NetworkResult f = run_network(scenario, population, {}, 1, {});
            EXPECT_TRUE(f.violations.none()) << edge_m << " m, population " << population << ", overlaps "
                                             << f.violations.overlaps << ", conflicts " << f.violations.conflicts;
            EXPECT_GT(f.exited, 40) << edge_m;
        }
    }
}

TEST(SumoRun, VehiclesYieldToArrivalsAcrossAnEmptyShortEdge) {
    const std::string traffic =
        R"xml(<flow id="b" from="b" to="c" period="exp(0.12)" end="270" departSpeed="max"/>
<flow id="x" from="b" to="x" period="exp(0.05)" end="270" departSpeed="max"/>
<flow id="a" from="a" to="c" period="exp(0.07)" end="270" departSpeed="max"/>)xml";
    for (int seed = 1; seed <= 8; ++seed) {
        const Scenario scenario =
            scenario_of(testing::roundabout_net(), traffic, "fidelity: meso\nseed: " + std::to_string(seed) + "\n");
        const NetworkResult f = run_network(scenario, 1, {}, 1, {});
        EXPECT_TRUE(f.violations.none()) << f.violations.overlaps << " overlaps, " << f.violations.conflicts
                                         << " conflicts";
        EXPECT_GT(f.exited, 40);
    }
}

// Each left-turning vehicle yields to oncoming traffic. It must not yield to vehicles that are stopped behind the
// opposing left-turning vehicle. Otherwise both left-turning vehicles would wait forever.
TEST(SumoRun, OpposingLeftTurnsDoNotBlockEachOther) {
    const Scenario scenario = scenario_of(testing::opposing_lefts_net(),
                                          R"(<flow id="wl" from="w" to="to_n" period="12" end="240" departSpeed="max"/>
<flow id="el" from="e" to="to_s" period="12" end="240" departSpeed="max"/>
<flow id="ws" from="w" to="to_e" period="3" begin="1" end="240" departSpeed="max"/>
<flow id="es" from="e" to="to_w" period="3" begin="1" end="240" departSpeed="max"/>)");
    for (std::size_t population = 0; population < 2; ++population) {
        const NetworkResult f = run_network(scenario, population, {}, 1, {});
        EXPECT_TRUE(f.violations.none()) << population;
        EXPECT_GT(f.exited, 100) << population;  // 0 if they block each other
    }
}

// The network fast_random comes from netgenerate --rand --rand.iterations 9 --default.speed 27.8 --tls.guess --seed 11,
// with random trips. A fast yielding vehicle has accepted a gap and can no longer stop. A stopped vehicle with priority
// must not start into its path.
TEST(SumoRun, VehicleWithPriorityWaitsForOneThatCannotStop) {
    const std::string data = STOPLINE_TEST_DATA_DIR;
    const Scenario scenario = parse_scenario(
        "fidelity: meso\nduration: 300 s\nnetwork: {kind: sumo, net: ./fast_random.net.xml, routes: [./fast_random.rou.xml]}\n"
        "populations: [CDG, CTG-Ref]\nrules: {teleport_cycles: 3}\nmeasure: {window: 100 s}\n",
        "my.yaml", {}, data);
    for (std::size_t population = 0; population < 2; ++population) {
        const NetworkResult f = run_network(scenario, population, {}, 1, {});
        EXPECT_TRUE(f.violations.none()) << f.violations.conflicts << " conflicts of population " << population;
        EXPECT_EQ(f.exited, f.entered);
    }
}

TEST(SumoRun, TeleportAvoidsEdgesShorterThanTheVehicle) {
    std::string net = testing::merge_net("0.5");
    net = testing::replaced(net, "<junction id=\"J\" type=\"priority\"",
                            "<tlLogic id=\"J\" type=\"static\" programID=\"0\" offset=\"0\">"
                            "<phase duration=\"8\" state=\"rG\"/><phase duration=\"2\" state=\"ry\"/></tlLogic>\n"
                            "<junction id=\"J\" type=\"traffic_light\"");
    net = testing::replaced(net, "via=\":J_0_0\"", "via=\":J_0_0\" tl=\"J\" linkIndex=\"0\"");
    net = testing::replaced(net, "via=\":J_1_0\"", "via=\":J_1_0\" tl=\"J\" linkIndex=\"1\"");
    const Scenario scenario = scenario_of(net, R"(<flow id="b" from="b" to="c" period="4" end="200" departSpeed="max"/>
<flow id="a" from="a" to="c" period="20" end="200" departSpeed="max"/>)",
                                          "fidelity: meso\nrules: {teleport_cycles: 3}\n");
    const NetworkResult f = run_network(scenario, 0, {}, 1, {});
    EXPECT_TRUE(f.violations.none()) << f.violations.overlaps << " overlaps, " << f.violations.conflicts
                                     << " conflicts";
    EXPECT_GE(f.exited, 53);
}

TEST(SumoRun, VehicleAtTheEndOfItsTripSeesAVehicleStillReachingBack) {
    const Scenario scenario =
        scenario_of(crossing_net(), R"(<trip id="a" depart="0" from="w_in" to="e_out" departSpeed="max"/>)");
    const Model model = network_model(scenario, 0);
    Simulation simulation(model);
    const auto lane_named = [&](const std::string& name) {
        for (std::size_t k = 0; k < model.graph.lanes.size(); ++k) {
            if (model.graph.lanes[k].name == name) return static_cast<int>(k);
        }
        return -1;
    };
    const State& state = simulation.state();
    while (state.blocks[static_cast<std::size_t>(lane_named(":J_1_0"))].count == 0) simulation.step();
    const int lane = lane_named("w_in_0");
    const int approach = model.graph.lanes[static_cast<std::size_t>(lane)].approach;
    const LeaderAhead ahead = leader_ahead(state, lane, 180.0, {state.plan.route_with(approach, Turn::none)}, 100.0);
    EXPECT_EQ(ahead.slot, state.blocks[static_cast<std::size_t>(lane_named(":J_1_0"))].first);
    EXPECT_NEAR(ahead.lane_start_m, 190.0, 0.01);
}

TEST(SumoRun, VehiclesJoinTheBacklogWithoutRoom) {
    const std::string net = signal_net(R"(<phase duration="299" state="rrrr"/><phase duration="1" state="GGGG"/>)");
    const NetworkResult f = run_network(
        scenario_of(net, R"(<flow id="s" from="s_in" to="n_out" number="60" begin="0" end="100"/>)"), 0, {}, 1, {});
    EXPECT_GT(f.backlog, 20);
    EXPECT_EQ(f.entered + f.backlog, 60);
    EXPECT_TRUE(f.violations.none());
}

TEST(SumoRun, ScenarioHashCoversTheFiles) {
    const std::uint64_t hash = scenario_of(crossing_net(), kBusyRoutes).hash;
    EXPECT_EQ(scenario_of(crossing_net(), kBusyRoutes).hash, hash);
    EXPECT_NE(scenario_of(crossing_net(), std::string(kBusyRoutes) + " ").hash, hash);
    EXPECT_NE(scenario_of(crossing_net() + " ", kBusyRoutes).hash, hash);
}

TEST(SumoRun, ReportsTheMeasuredWindow) {
    const auto window = [](double duration_s, double window_s) {
        Scenario scenario = scenario_of(crossing_net(), kBusyRoutes);
        scenario.duration_s = duration_s;
        scenario.measure.window_s = window_s;
        scenario.measure.interval_s = 60.0;
        return window_text(run_networks(scenario, {}));
    };
    EXPECT_EQ(window(240.0, 120.0), "Measured from 120 to 240 s.");
    EXPECT_EQ(window(260.0, 160.0),
              "Measured from 120 to 240 s. measure.window gives 100 to 260 s; only whole intervals of 60 s "
              "(measure.interval) are measured.");
    EXPECT_EQ(window(240.0, 500.0),
              "Measured from 0 to 240 s. measure.window is 500 s, but the run lasts 240 s: the run is measured from "
              "its start, because it is too short to find the end of its warm-up. That takes at least 15 min (15 times "
              "measure.interval). Increase 'duration', or set a measure.window shorter than the run.");
    EXPECT_NE(window(890.0, 1000.0).find("too short to find the end of its warm-up"), std::string::npos);
    const std::string long_run = window(900.0, 1000.0);
    EXPECT_NE(long_run.find("to 900 s. measure.window is 1000 s, but the run lasts 900 s: each population is measured "
                            "from the end of its warm-up."),
              std::string::npos)
        << long_run;
    EXPECT_EQ(window(240.0, 30.0),
              "Nothing is measured: the last 30 s of the run contain no whole interval of 60 s (measure.interval).");
}

TEST(SumoScenario, RefusesFieldsThatItDoesNotUse) {
    const auto error_with = [](const std::string& settings) {
        return testing::refusal([&] { scenario_of(crossing_net(), kBusyRoutes, settings); });
    };
    EXPECT_NE(error_with("demand: {vehicles: 3}\n").find("field 'demand' applies only if"), std::string::npos);
    EXPECT_NE(error_with("signal: {green: 3 s}\n").find("field 'signal' applies only if"), std::string::npos);
}

TEST(SumoScenario, ErrorsPointToFilesThatCannotBeRead) {
    const SumoFiles files;
    files.write("my.net.xml", crossing_net());
    const auto error_with = [&](const std::string& network) {
        return testing::refusal([&] {
            parse_scenario("duration: 300 s\nnetwork:\n  kind: sumo\n" + network, "my.yaml", {}, files.folder());
        });
    };
    EXPECT_EQ(
        error_with("  net: ./none.net.xml\n"),
        "my.yaml:4:8: field 'network.net': " + (files.folder() / "none.net.xml").string() + ": there is no such file");
    const std::string both =
        error_with("  net: ./my.net.xml\n  routes: [., ./none.rou.xml]\n  additional: [/dev/zero]\n");
    EXPECT_NE(both.find("my.yaml:5:12: field 'network.routes[0]': "), std::string::npos) << both;
    EXPECT_NE(both.find("my.yaml:5:15: field 'network.routes[1]': "), std::string::npos) << both;
    EXPECT_NE(both.find("my.yaml:6:16: field 'network.additional[0]': /dev/zero: this is a device or a pipe"),
              std::string::npos)
        << both;
}

TEST(SumoScenario, WarnsIfNoVehicleDeparts) {
    const auto warning = [](const std::string& routes) {
        return sumo_demand_warning(scenario_of(crossing_net(), routes));
    };
    EXPECT_EQ(warning(kBusyRoutes), "");
    const std::string late = "no vehicle departs: the run ends at 300 s (duration), but the first vehicle departs at ";
    EXPECT_EQ(
        warning(
            R"(<trip id="b" depart="500" from="w_in" to="e_out"/><trip id="a" depart="300" from="w_in" to="e_out"/>)"),
        late + "300 s");
    EXPECT_EQ(warning(R"(<flow id="a" begin="1000" end="2000" number="5" from="w_in" to="e_out"/>)"), late + "1000 s");
    EXPECT_NE(warning(R"(<vType id="b" vClass="bicycle"/><trip id="a" type="b" depart="0" from="w_in" to="e_out"/>)")
                  .find("no vehicle has a route in this network"),
              std::string::npos);
    const NetworkResult f =
        run_network(scenario_of(crossing_net(), R"(<trip id="a" depart="300" from="w_in" to="e_out"/>)"), 0, {}, 1, {});
    EXPECT_EQ(f.entered, 0);
    EXPECT_TRUE(f.violations.none());
}

TEST(SumoScenario, RefusesRoutesWithoutVehicles) {
    const std::string message =
        testing::refusal([] { scenario_of(crossing_net(), R"(<vType id="a"/><route id="r" edges="w_in e_out"/>)"); });
    EXPECT_EQ(
        message,
        "my.yaml:3:50: field 'network.routes': the files of 'routes' and 'additional' have no vehicle, trip or flow");
}

}  // namespace
}  // namespace stopline
