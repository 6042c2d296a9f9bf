// Runs of intersections and grids with the controller `dual_ring`.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "base/containers/index.h"
#include "runs/intersection/intersection_run.h"
#include "runs/network/network_run.h"
#include "scenario/build_model.h"
#include "scenario/load_scenario.h"
#include "sim/step/simulation.h"

namespace stopline {
namespace {

Scenario dual_ring(std::vector<std::string> settings = {}) {
    settings.insert(settings.begin(), {"populations=[CDG]", "measure.baseline=CDG"});
    return load_scenario(STOPLINE_SOURCE_DIR "/scenarios/dual_ring.yaml", settings);
}

TEST(DualRingRuns, CoordinatedStreetsHaveGreenInEachCycle) {
    const Scenario scenario = dual_ring();
    const Model model = build_model(scenario, 0);
    Simulation simulation(model);
    std::vector<int> greens(at(model.graph.signal_groups));
    int at_point = 0;
    const RingPlan& rings = model.signals[0].phases.rings;
    while (simulation.time_s() < 1.0 + 900.0) {
        const std::vector<Light> before = simulation.state().signals.lights;
        simulation.step();
        const SignalState& signals = simulation.state().signals;
        for (std::size_t group = 0; group < before.size(); ++group) {
            if (before[group] != Light::green && signals.lights[group] == Light::green) ++greens[group];
        }
        if (signals.phase[0] < 0 || rings.ticks_to(rings.phases[1].start_point, simulation.state().tick) != 0) continue;
        EXPECT_EQ(rings.pairs[at(signals.phase[0])].phase[0], 1);
        EXPECT_EQ(rings.pairs[at(signals.phase[0])].phase[1], 5);
        ++at_point;
    }
    EXPECT_GE(at_point, 9);
    EXPECT_GE(*std::min_element(greens.begin(), greens.end()), 3) << "every movement has green";
    EXPECT_TRUE(simulation.state().records.violations.none());
    EXPECT_GT(simulation.state().records.exited, 400);
}

// Left turns are protected in phases 1 and 5, and permissive beside the straight traffic of their approach.
TEST(DualRingRuns, RightOfWayFollowsThePhasesOfBothRings) {
    const Scenario scenario = dual_ring({"demand.inflow=700 veh/h"});
    const Model model = build_model(scenario, 0);
    Simulation simulation(model);
    int permissive_waits = 0;
    int protected_waits = 0;
    while (simulation.time_s() < 900.0) {
        simulation.step();
        const State& state = simulation.state();
        // The time since the last green of the signal lets vehicles leave that still wait in the junction.
        if (state.signals.phase[0] < 0 || state.tick - state.signals.phase_start_tick[0] < 50) continue;
        const RingPair pair = model.signals[0].phases.rings.pairs[at(state.signals.phase[0])];
        for (std::size_t lane = 0; lane < model.graph.lanes.size(); ++lane) {
            const Lane& connection = model.graph.lanes[lane];
            if (connection.turn != Turn::left || connection.origin < 0) continue;
            if (!model.graph.lanes[at(connection.origin)].name.starts_with("west")) continue;
            for (int k = 0; k < yield_stops_of(state, static_cast<int>(lane)).count; ++k) {
                if (yield_stops_of(state, static_cast<int>(lane)).stops[at(k)].reason != YieldReason::priority)
                    continue;
                (pair.phase[0] == 0 ? protected_waits : permissive_waits) += 1;
            }
        }
    }
    EXPECT_EQ(protected_waits, 0);
    EXPECT_GT(permissive_waits, 20);
    EXPECT_TRUE(simulation.state().records.violations.none());
}

TEST(DualRingRuns, BothFidelitiesHaveNoViolations) {
    for (const char* const fidelity : {"fidelity=meso", "fidelity=full"}) {
        for (const char* const cycle : {"signal.cycle=90 s", "signal.cycle=0 s"}) {
            std::vector<std::string> settings{fidelity, "measure.cycles=3", "measure.warmup_cycles=1"};
            if (std::string(cycle) == "signal.cycle=0 s") {
                settings.insert(settings.end(),
                                {cycle, "signal.phases[1].coordinated=off", "signal.phases[5].coordinated=off"});
            }
            const IntersectionResult result = run_intersection(dual_ring(settings), 0);
            EXPECT_TRUE(result.violations.none()) << fidelity << ", " << cycle;
            // Four approaches of 600 vehicles an hour, far below saturation.
            EXPECT_NEAR(result.throughput_veh_h, 2400.0, 300.0) << fidelity << ", " << cycle;
        }
    }
}

TEST(DualRingRuns, AGridHasTheSameHashWithSeveralThreads) {
    for (const char* const fidelity : {"fidelity=meso", "fidelity=full"}) {
        const Scenario rings =
            dual_ring({fidelity, "network.kind=grid", "network.grid={columns: 2, rows: 2}", "duration=240 s",
                       "measure={baseline: CDG, window: 120 s}", "signal.offset=12 s"});
        const NetworkResult one = run_network(rings, 0);
        EXPECT_TRUE(one.violations.none());
        EXPECT_EQ(one.state_hash, run_network(rings, 0, {}, 2).state_hash) << fidelity;
        EXPECT_EQ(one.state_hash, run_network(rings, 0, {}, 4).state_hash) << fidelity;
        const Scenario other =
            dual_ring({fidelity, "network.kind=grid", "network.grid={columns: 2, rows: 2}", "duration=240 s",
                       "measure={baseline: CDG, window: 120 s}", "signal.offset=13 s"});
        EXPECT_NE(one.state_hash, run_network(other, 0).state_hash) << fidelity;
    }
}

}  // namespace
}  // namespace stopline
