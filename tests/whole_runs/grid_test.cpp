// Simulates networks of several intersections in both fidelities. Vehicles enter at their rates, turn in their shares
// and cause no violations.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/containers/index.h"
#include "runs/network/network_run.h"
#include "scenario/build_model.h"
#include "scenario/load_scenario.h"
#include "sim/step/simulation.h"

namespace stopline {
namespace {

Scenario calibration(const std::vector<std::string>& overrides) {
    return load_scenario(STOPLINE_SOURCE_DIR "/scenarios/calibration.yaml", overrides);
}

// An inflow of 600 veh/h on the two lanes of an approach gives one vehicle every 12 s on each lane.
TEST(Inflow, EntersEvenlyAtItsRate) {
    const Scenario scenario = load_scenario(STOPLINE_SOURCE_DIR "/scenarios/grid.yaml",
                                            {"demand={kind: rate, inflow: 600 veh/h, left: 5 %, right: 10 %}",
                                             "network.grid.columns=2", "network.grid.rows=2", "signal.green=20 s"});
    const Model model = build_model(scenario, 0);
    Simulation simulation(model);
    std::vector<double> last_entry_s(model.graph.lanes.size(), -1.0);
    simulation.run_until(1200.0);
    int vehicles = 0;
    for (const Passage& passage : simulation.state().records.passages) {
        if (passage.from_lane >= 0) continue;
        ++vehicles;
        double& previous_s = last_entry_s[at(passage.to_lane)];
        if (previous_s >= 0.0) {
            EXPECT_NEAR(passage.time_s - previous_s, 12.0, 0.11);
        }
        previous_s = passage.time_s;
    }
    EXPECT_NEAR(vehicles, 8 * 2 * 100, 16);
    EXPECT_TRUE(simulation.state().records.violations.none());
}

// The cross streets have an inflow of 200 veh/h on two lanes, so one vehicle enters every 36 s on each lane. The main
// street is saturated.
TEST(Inflow, CrossStreetsHaveTheirOwnRate) {
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

// On an entry lane without a straight movement, the shares of the turns are scaled to a sum of 1.
TEST(TurnShares, AreScaledOnALaneWithoutStraightMovement) {
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

// Vehicles that enter between two intersections are inserted without overlap into the traffic from the upstream
// intersection. The results of the run include them.
TEST(Inflow, BetweenTwoIntersectionsIsInsertedAndMeasured) {
    for (const char* const fidelity : {"full", "meso"}) {
        for (const char* const approaches : {"[c0r1_south]", "[c0r0_south, c0r1_south]"}) {
            Scenario scenario = load_scenario(
                STOPLINE_SOURCE_DIR "/scenarios/grid.yaml",
                {"network.grid.columns=2", "network.grid.rows=2", "duration=400 s", "measure.window=400 s",
                 std::string("fidelity=") + fidelity, std::string("demand.approaches=") + approaches});
            const NetworkResult result = run_network(scenario, 0, {}, 1, {});
            EXPECT_TRUE(result.violations.none()) << fidelity << approaches;
            EXPECT_GT(result.exited, 50) << fidelity << approaches;
            std::int64_t measured = 0;
            for (const NetworkInterval& interval : result.series) measured += interval.area.exited;
            EXPECT_GT(measured, result.exited / 2) << fidelity << approaches;
        }
    }
}

// Regression test: two vehicles were in the same conflict area at 1,917 s. A left-turning vehicle L had accepted a gap
// far upstream, behind another left-turning vehicle that waited. After the waiting vehicle has started, L must not rely
// on this gap.
TEST(Inflow, LightTrafficHasNoConflicts) {
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

// Regression test: two vehicles were in the same conflict area at 3,908 s. A vehicle has accepted a gap and must then
// wait for traffic beyond the conflict area. Its acceptance must stay valid until it has passed the conflict area.
TEST(Saturated, SlowTrafficHasNoConflicts) {
    const Scenario scenario = load_scenario(
        STOPLINE_SOURCE_DIR "/scenarios/grid.yaml",
        {"demand.left=5 %", "demand.right=10 %", "signal.green=20 s", "signal.offset=10 s", "seed=2", "meso=fitted"});
    const Model model = network_model(scenario, 2);
    Simulation simulation(model);
    simulation.run_until(3910.0);
    EXPECT_TRUE(simulation.state().records.violations.none());
}

// Coordinated signals repeat in every cycle, so every intersection turns green within the first cycle, even if the sum
// of its offsets is longer than a cycle. Each intersection turns green one offset after its upstream neighbour.
TEST(GridSignals, TurnGreenWithinTheFirstCycleInOffsetOrder) {
    const Scenario scenario =
        load_scenario(STOPLINE_SOURCE_DIR "/scenarios/grid.yaml", {"signal.green=10 s", "signal.offset=15 s"});
    const Model model = build_model(scenario, 0);
    const std::int64_t cycle = to_ticks(36.0, model.step_s);
    const std::int64_t offset = to_ticks(15.0, model.step_s);
    const auto first_green = [&](int group) {
        std::int64_t tick = 0;
        while (model.signals.programme(group).light(tick) != Light::green) ++tick;
        return tick;
    };
    const std::vector<GridPosition> positions = grid_positions(scenario.network.grid);
    ASSERT_EQ(model.signals.size(), positions.size());
    ASSERT_EQ(model.signals.groups(), 2 * static_cast<int>(positions.size()));
    for (int k = 0; k < static_cast<int>(positions.size()); ++k) {
        const GridPosition& place = positions[static_cast<std::size_t>(k)];
        EXPECT_LE(first_green(2 * k), cycle + to_ticks(1.0, model.step_s));
        EXPECT_LE(first_green(2 * k + 1), 2 * cycle);
        EXPECT_EQ((first_green(2 * k) - first_green(0) - (place.column + place.row) * offset) % cycle, 0);
    }
}

TEST(TurnShares, CrossStreetsHaveTheirOwn) {
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

TEST_P(OnGrid, SlowEveryQueuedVehicleExitsWithoutViolation) {
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

// Only one approach has demand, so nothing holds its traffic up for long. Downstream of every intersection a fifth of
// the vehicles of each lane turns: 4 in each block of 20.
TEST_P(OnGrid, SlowTurnSharesHoldDownstreamOfEveryIntersection) {
    constexpr int kVehicles = 300;  // per lane
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
        const Lane& connection = model.graph.lanes[at(passage.to_lane)];
        ++passed[at(connection.origin)];
        turned[at(connection.origin)] += connection.turn != Turn::straight ? 1 : 0;
    }
    int used = 0;
    for (const int link : model.graph.links) {
        if (passed[at(link)] == 0) continue;
        ++used;
        // Each complete block of 20 vehicles has exactly 4 turns. The last block may be incomplete, so the number of
        // turns differs from a fifth of the vehicles by at most 4.
        EXPECT_NEAR(turned[at(link)], 0.2 * passed[at(link)], 4.0) << model.graph.lanes[at(link)].name;
    }
    // Two lanes lead to the centre and two from there to the north. One lane leads to the west and one to the east.
    EXPECT_EQ(used, 6);
}

INSTANTIATE_TEST_SUITE_P(Fidelities, OnGrid, testing::Values("full", "meso"));

// The higher inflow exceeds the capacity of the approaches. Vehicles that cannot enter join the backlog.
TEST(Inflow, EntersOrJoinsTheBacklog) {
    for (const double inflow_veh_h : {300.0, 2000.0}) {
        const Scenario scenario = load_scenario(
            STOPLINE_SOURCE_DIR "/scenarios/grid.yaml",
            {"demand={kind: rate, left: 5 %, right: 10 %, inflow: " + std::to_string(inflow_veh_h) + " veh/h}",
             "network.grid.columns=2", "network.grid.rows=2", "duration=900 s", "measure.window=300 s"});
        const NetworkResult result = run_network(scenario, 0);
        constexpr double kApproaches = 8.0;
        constexpr double kTolerance = 16.0;  // one vehicle for each entry lane
        EXPECT_NEAR(static_cast<double>(result.entered + result.backlog), kApproaches * inflow_veh_h * 0.25,
                    kTolerance);
        EXPECT_EQ(result.backlog > 100, inflow_veh_h > 1000.0) << result.backlog;
    }
}

}  // namespace
}  // namespace stopline
