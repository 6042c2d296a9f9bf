// Vehicles on several intersections, in both modes: nobody is lost or in another's way, and at each intersection the next turn
// is drawn with its share.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/containers/index.h"
#include "scenario/build_model.h"
#include "runs/network/network_run.h"
#include "scenario/load_scenario.h"
#include "sim/step/simulation.h"

namespace stopline {
namespace {

Scenario calibration(const std::vector<std::string>& overrides) {
    return load_scenario(STOPLINE_SOURCE_DIR "/scenarios/calibration.yaml", overrides);
}

// 600 vehicles an hour and arm, two lanes: one every 12 s a lane, as long as the road takes them.
TEST(Inflow, ComesEvenlyAtItsRate) {
    const Scenario scenario = load_scenario(STOPLINE_SOURCE_DIR "/scenarios/grid.yaml",
                                            {"demand={kind: rate, inflow: 600 veh/h, left: 5 %, right: 10 %}",
                                             "network.grid.columns=2", "network.grid.rows=2", "signal.green=20 s"});
    const Model model = build_model(scenario, 0);
    Simulation simulation(model);
    std::vector<double> entry_s(model.graph.lanes.size(), -1.0);
    simulation.run_until(1200.0);
    int vehicles = 0;
    for (const Passage& passage : simulation.state().records.passages) {
        if (passage.from_lane >= 0) continue;
        ++vehicles;
        double& before_s = entry_s[at(passage.to_lane)];
        if (before_s >= 0.0) {
            EXPECT_NEAR(passage.time_s - before_s, 12.0, 0.11);
        }
        before_s = passage.time_s;
    }
    EXPECT_NEAR(vehicles, 8 * 2 * 100, 16);
    EXPECT_TRUE(simulation.state().records.violations.none());
}

// Streets that cross with a rate of their own: one vehicle every 36 s a lane of theirs, while the others never run dry.
TEST(Inflow, OfStreetsThatCrossIsTheirOwn) {
    const Scenario scenario =
        load_scenario(STOPLINE_SOURCE_DIR "/scenarios/arterial.yaml", {"demand.cross_inflow=200 veh/h"});
    const Model model = build_model(scenario, 0);
    Simulation simulation(model);
    simulation.run_until(1800.0);
    const State& state = simulation.state();
    for (std::size_t k = 0; k < model.graph.entries.size(); ++k) {
        const Lane& lane = model.graph.lanes[at(model.graph.entries[k])];
        if (lane.signal_group % 2 == 1) {
            EXPECT_NEAR(static_cast<double>(state.insertion.inlets[k].entered), 50.0, 1.0) << lane.name;
        } else {
            EXPECT_GT(state.insertion.inlets[k].entered, 150) << lane.name;
        }
    }
    EXPECT_TRUE(state.records.violations.none());
}

// Where nobody can go straight on, shares are in proportion to each other.
TEST(TurnShares, AreScaledWhereAllTurn) {
    const Scenario scenario =
        load_scenario(STOPLINE_SOURCE_DIR "/scenarios/intersection.yaml",
                      {"network.intersection.lanes=[{movements: straight+left+right}, {movements: left+right}]",
                       "demand.left=60 %", "demand.right=20 %"});
    const Model model = build_model(scenario, 0);
    for (const DemandPlan::Inlet& inlet : model.demand.inlets) {
        const bool all_turn = inlet.routes.size() == 2;
        for (std::size_t k = 0; k < inlet.routes.size(); ++k) {
            const Turn turn = model.graph.lanes[at(model.graph.routes[at(inlet.routes[k])].lanes[1])].turn;
            const double share = turn == Turn::left ? 0.6 : 0.2;
            EXPECT_NEAR(inlet.shares[k], all_turn ? share / 0.8 : share, 1e-12);
        }
    }
}

// Between two intersections, into the traffic that comes from the first one, nobody enters on top of another; all are measured.
TEST(Inflow, BetweenTwoIntersectionsFindsItsPlaceAndIsMeasured) {
    for (const char* const fidelity : {"full", "meso"}) {
        for (const char* const arms : {"[c0r1_south]", "[c0r0_south, c0r1_south]"}) {
            Scenario scenario = load_scenario(
                STOPLINE_SOURCE_DIR "/scenarios/grid.yaml",
                {"network.grid.columns=2", "network.grid.rows=2", "duration=400 s", "measure.window=400 s",
                 std::string("fidelity=") + fidelity, std::string("demand.approaches=") + arms});
            const NetworkResult figures = run_network(scenario, 0, {}, 1, {});
            EXPECT_TRUE(figures.violations.none()) << fidelity << arms;
            EXPECT_GT(figures.exited, 50) << fidelity << arms;
            std::int64_t measured = 0;
            for (const NetworkInterval& interval : figures.series) measured += interval.area.exited;
            EXPECT_GT(measured, figures.exited / 2) << fidelity << arms;
        }
    }
}

// A left turner that accepted a gap from afar, behind one that waited, must not count on it when that one sets out: here, at 1,917 s,
// two once were in the same conflict area.
TEST(Inflow, ThatIsLightIsNeverInTheSameConflictArea) {
    const Scenario scenario =
        load_scenario(STOPLINE_SOURCE_DIR "/scenarios/grid.yaml",
                      {"demand={kind: rate, inflow: 600 veh/h, left: 10 %, right: 30 %}", "network.grid.columns=2",
                       "network.grid.rows=2", "signal.green=30 s", "signal.offset=0 s", "seed=7", "meso=fitted"});
    const Model model = build_model(scenario, 2);
    Simulation simulation(model);
    simulation.run_until(2000.0);
    EXPECT_GT(simulation.state().records.gaps_accepted.size(), 100U);
    EXPECT_TRUE(simulation.state().records.violations.none());
}

// One that has accepted a gap and is held up beyond the area must not lose it before it has used it: here, at 3,908 s, another came.
TEST(Saturated, SlowTrafficIsNeverInTheSameConflictArea) {
    const Scenario scenario = load_scenario(
        STOPLINE_SOURCE_DIR "/scenarios/grid.yaml",
        {"demand.left=5 %", "demand.right=10 %", "signal.green=20 s", "signal.offset=10 s", "seed=2", "meso=fitted"});
    const Model model = network_model(scenario, 2);
    Simulation simulation(model);
    simulation.run_until(3910.0);
    EXPECT_TRUE(simulation.state().records.violations.none());
}

// Coordinated signals run in every cycle: the farthest intersection does not stay red until its offsets add up, and each is green later
// by the offset than the one before it.
TEST(Signals, OfAGridAreAllGreenWithinTheFirstCycle) {
    const Scenario scenario =
        load_scenario(STOPLINE_SOURCE_DIR "/scenarios/grid.yaml", {"signal.green=10 s", "signal.offset=15 s"});
    const Model model = build_model(scenario, 0);
    const std::int64_t cycle = to_ticks(36.0, model.step_s);
    const std::int64_t offset = to_ticks(15.0, model.step_s);
    const auto first_green = [&](std::size_t group) {
        std::int64_t tick = 0;
        while (model.signals[group].light(tick) != Light::green) ++tick;
        return tick;
    };
    const std::vector<GridPosition> places = grid_positions(scenario.network.grid);
    ASSERT_EQ(model.signals.size(), 2 * places.size());
    for (std::size_t k = 0; k < places.size(); ++k) {
        EXPECT_LE(first_green(2 * k), cycle + to_ticks(1.0, model.step_s));
        EXPECT_LE(first_green(2 * k + 1), 2 * cycle);
        EXPECT_EQ((first_green(2 * k) - first_green(0) - (places[k].column + places[k].row) * offset) % cycle, 0);
    }
}

// Where streets that cross have turns of their own, each keeps its share.
TEST(CrossTurns, AreThoseOfTheStreetsThatCross) {
    const Scenario scenario = load_scenario(STOPLINE_SOURCE_DIR "/scenarios/arterial.yaml", {"demand.left=10 %"});
    const Model model = build_model(scenario, 0);
    for (std::size_t k = 0; k < model.demand.inlets.size(); ++k) {
        const DemandPlan::Inlet& inlet = model.demand.inlets[k];
        const bool crosses = model.graph.lanes[at(inlet.lane)].signal_group % 2 == 1;
        for (std::size_t r = 0; r < inlet.routes.size(); ++r) {
            const Turn turn = model.graph.lanes[at(model.graph.routes[at(inlet.routes[r])].lanes[1])].turn;
            if (turn == Turn::left) {
                EXPECT_EQ(inlet.shares[r], crosses ? 0.2 : 0.1);
            }
            if (turn == Turn::right) {
                EXPECT_EQ(inlet.shares[r], crosses ? 0.4 : 0.0);
            }
        }
    }
}

class OnGrid : public testing::TestWithParam<const char*> {};

TEST_P(OnGrid, SlowEveryVehicleOfAQueueComesThroughWithoutHarm) {
    for (const char* green : {"signal.green=5 s", "signal.green=30 s"}) {
        const Scenario scenario = calibration({std::string("fidelity=") + GetParam(), green, "signal.offset=15 s"});
        const Model model = build_model(scenario, 4);
        Simulation simulation(model);
        while (simulation.time_s() < 1000.0 && simulation.state().records.exited < 36) simulation.step();
        EXPECT_EQ(simulation.state().records.entered, 36);
        EXPECT_EQ(simulation.state().records.exited, 36);
        EXPECT_TRUE(simulation.state().records.violations.none());
    }
}

// Traffic from one side only, which nothing holds up for long: of all that come to the intersections behind, a fifth of each lane
// turns, in every 20 vehicles.
TEST_P(OnGrid, SlowTurnsHaveTheirShareBehindEveryIntersection) {
    constexpr int kVehicles = 300;  // a lane
    Scenario scenario =
        calibration({std::string("fidelity=") + GetParam(), "signal.green=20 s", "demand.vehicles=300"});
    scenario.demand.approaches = {"c1r0_south"};
    scenario.demand.left_share = scenario.demand.right_share = 0.2;
    const Model model = build_model(scenario, 0);
    Simulation simulation(model);
    while (simulation.time_s() < 4000.0 && simulation.state().records.exited < 2 * kVehicles) simulation.step();
    EXPECT_EQ(simulation.state().records.exited, 2 * kVehicles);
    EXPECT_TRUE(simulation.state().records.violations.none());
    std::vector<int> turned(model.graph.lanes.size(), 0);
    std::vector<int> passed(model.graph.lanes.size(), 0);
    for (const Passage& passage : simulation.state().records.passages) {
        if (passage.to_lane < 0 || model.graph.lanes[at(passage.to_lane)].origin < 0) continue;
        const Lane& inside = model.graph.lanes[at(passage.to_lane)];
        ++passed[at(inside.origin)];
        turned[at(inside.origin)] += inside.turn != Turn::straight ? 1 : 0;
    }
    int used = 0;
    for (const int link : model.graph.links) {
        if (passed[at(link)] == 0) continue;
        ++used;
        // Of a block of 20 that is not complete, at most 4 turns are missing or ahead.
        EXPECT_NEAR(turned[at(link)], 0.2 * passed[at(link)], 4.0) << model.graph.lanes[at(link)].name;
    }
    EXPECT_EQ(used, 6);  // to the centre and, beyond it, to the north on both lanes, to the west and the east on one
}

INSTANTIATE_TEST_SUITE_P(Modes, OnGrid, testing::Values("full", "meso"));

// More than the road takes: who has come and is not in the network waits outside.
TEST(Inflow, EntersOrWaits) {
    for (const double inflow_veh_h : {300.0, 2000.0}) {
        const Scenario scenario = load_scenario(
            STOPLINE_SOURCE_DIR "/scenarios/grid.yaml",
            {"demand={kind: rate, left: 5 %, right: 10 %, inflow: " + std::to_string(inflow_veh_h) + " veh/h}",
             "network.grid.columns=2", "network.grid.rows=2", "duration=900 s", "measure.window=300 s"});
        const NetworkResult figures = run_network(scenario, 0);
        constexpr double kArms = 8.0;
        constexpr double kLanes = 16.0;  // each of which may have one more or less
        EXPECT_NEAR(static_cast<double>(figures.entered + figures.backlog), kArms * inflow_veh_h * 0.25, kLanes);
        EXPECT_EQ(figures.backlog > 100, inflow_veh_h > 1000.0) << figures.backlog;
    }
}

}  // namespace
}  // namespace stopline
