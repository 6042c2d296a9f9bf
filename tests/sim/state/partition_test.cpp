// A run gives the same bits and events for any number of threads, and with the scalar kernels. Each thread computes one
// partition of the lanes. In the simulated networks junctions are blocked, gridlocks form, and vehicles are teleported
// or pass blockers.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "scenario/build_model.h"
#include "scenario/load_scenario.h"
#include "sim/step/simulation.h"

namespace stopline {
namespace {

// Returns a grid with short streets and many turns, which gridlocks within minutes.
Model crowded_grid(const std::string& fidelity, int population, const std::string& meso = "passages") {
    const Scenario scenario =
        load_scenario(STOPLINE_SOURCE_DIR "/scenarios/grid.yaml",
                      {"fidelity=" + fidelity, "meso=" + meso, "network.grid.columns=3", "network.grid.rows=3",
                       "network.grid.column_spacing=150 m", "network.grid.row_spacing=150 m", "demand.left=15 %",
                       "rules.teleport_cycles=1", "rules.pass_blocker_greens=0.5", "signal.green=20 s",
                       "network.intersection.approach_length=150 m"});
    return build_model(scenario, static_cast<std::size_t>(population));
}

// Returns all events and statistics of a run as text.
std::vector<std::string> report(const State& state) {
    std::vector<std::string> lines;
    for (const RuleUse& use : state.congestion.delays.rule_uses) {
        lines.push_back("rule " + std::to_string(static_cast<int>(use.kind)) + " " + std::to_string(use.time_s) + " " +
                        std::to_string(use.vehicle) + " " + std::to_string(use.lane) + " " +
                        std::to_string(use.blocker));
    }
    for (const Crossing& crossing : state.records.crossings) {
        lines.push_back("crossing " + std::to_string(crossing.time_s) + " " + std::to_string(crossing.vehicle) + " " +
                        std::to_string(crossing.detector));
    }
    for (const GapAccepted& gap : state.records.gaps_accepted) {
        lines.push_back("gap " + std::to_string(gap.time_s) + " " + std::to_string(gap.vehicle));
    }
    for (const double delay_s : state.congestion.delays.delay_s) lines.push_back("delay " + std::to_string(delay_s));
    lines.push_back("longest " + std::to_string(state.records.longest_in_junction_ticks) + ", updates " +
                    std::to_string(state.records.updates));
    return lines;
}

void expect_same(Simulation& first, Simulation& second, double until_s, double every_s, const std::string& what) {
    for (int k = 1; k * every_s <= until_s; ++k) {
        first.run_until(k * every_s);
        second.run_until(k * every_s);
        ASSERT_EQ(first.state_hash(), second.state_hash())
            << what << ": first difference before " << k * every_s << " s";
    }
    ASSERT_EQ(report(first.state()), report(second.state())) << what;
    EXPECT_TRUE(first.state().records.violations.none());
    EXPECT_TRUE(second.state().records.violations.none());
}

TEST(Partitions, AnyNumberOfThreadsGivesTheSameRun) {
    for (const int population : {1, 2}) {
        const Model model = crowded_grid("meso", population);
        // Threads wait long for each other if there are fewer processors than threads. The run with three threads is
        // therefore shorter than the run with two.
        for (const int threads : {2, 3}) {
            Simulation alone(model);
            Simulation shared(model, threads);
            expect_same(alone, shared, threads == 2 ? 400.0 : 100.0, 20.0, std::to_string(threads) + " threads");
            if (population < 2 || threads > 2) continue;
            EXPECT_GT(alone.state().congestion.delays.teleported, 0);
        }
    }
}

// A connection without conflicts forms an intersection of its own, which may lie in another partition than the lanes at
// its ends. The longest time in a junction must include the time on such a connection.
TEST(Partitions, IncludeConnectionsWithoutConflicts) {
    const Scenario scenario = parse_scenario(
        "network: {kind: grid, intersection: {lanes: [{movements: straight+left}, {movements: right}], radius: 40 m, "
        "turn_speed: 5 m/s}}\n"
        "demand: {kind: queue, vehicles: 10}\n"
        "duration: 300 s\n"
        "measure: {window: 60 s}\n"
        "populations: [CTG-HBS]\n",
        "right_turns.yaml");
    const Model model = build_model(scenario, 0);
    Simulation alone(model);
    Simulation shared(model, 2);
    expect_same(alone, shared, 200.0, 50.0, "right turns");
    EXPECT_GT(model.time_s(alone.state().records.longest_in_junction_ticks), 10.0);
}

TEST(Partitions, ThreadsGiveTheSameRunInFullDynamics) {
    const Model model = crowded_grid("full", 2);
    Simulation alone(model);
    Simulation shared(model, 2);
    expect_same(alone, shared, 60.0, 10.0, "full dynamics");
}

// The vectorised kernels leave out standing queues. The scalar kernels evaluate all vehicles and must give the same
// result.
TEST(StandingQueues, LeavingThemOutChangesNothing) {
    // With the parameters `passages`, the vehicles of a queue relay a V2V message when the queue starts.
    for (const char* const meso : {"fitted", "passages"}) {
        for (const int population : {0, 1, 2}) {
            const Model model = crowded_grid("meso", population, meso);
            Model scalar = model;
            scalar.scalar_kernels = true;
            Simulation fast(model);
            Simulation complete(scalar);
            expect_same(fast, complete, 500.0, 10.0, std::string("scalar kernels, ") + meso);
        }
    }
}

// A slot is a place in the arrays of vehicle data. A slot without a vehicle has no id. The test also looks at sleeping
// lanes, for which no decisions are made until their signal is green: their first vehicle is stopped before this
// signal.
TEST(Slots, HaveNoIdWithoutAVehicle) {
    const Model model = crowded_grid("meso", 2);
    Simulation simulation(model, 2);
    bool slept = false;
    while (simulation.time_s() < 300.0) {
        for (int k = 0; k < 37; ++k) simulation.step();
        const State& state = simulation.state();
        std::vector<bool> occupied(static_cast<std::size_t>(state.vehicles.slots), false);
        const auto mark = [&](const LaneBlock& block) {
            for (int slot = block.first; slot < block.past_last(); ++slot)
                occupied[static_cast<std::size_t>(slot)] = true;
        };
        for (const LaneBlock& block : state.blocks) mark(block);
        mark(state.congestion.teleporting);
        for (std::size_t slot = 0; slot < occupied.size(); ++slot)
            ASSERT_EQ(state.vehicles.id[slot] >= 0, occupied[slot]);
        for (std::size_t lane = 0; lane < state.blocks.size(); ++lane) {
            if (state.queues.sleeps_until_green[lane] < 0) continue;
            slept = true;
            const LaneBlock& block = state.blocks[lane];
            EXPECT_EQ(state.stop_lines.lines[lane].stopping_vehicle,
                      state.vehicles.id[static_cast<std::size_t>(block.first)]);
            EXPECT_EQ(state.vehicles.speed_mps[static_cast<std::size_t>(block.first)], 0.0);
            EXPECT_EQ(state.stop_lines.stop_slot[lane], block.first);
        }
    }
    EXPECT_TRUE(slept);
}

// Each lane belongs to exactly one partition. All lanes of an intersection belong to the same one.
TEST(Partitions, DivideTheLanesByWholeIntersections) {
    const Model model = crowded_grid("meso", 0);
    for (const int threads : {1, 2, 4, 9, 30}) {
        const Simulation simulation(model, threads);
        const State& state = simulation.state();
        EXPECT_LE(state.partitions.size(), static_cast<std::size_t>(std::min(threads, 9)));
        std::vector<int> partition_of(model.graph.lanes.size(), -1);
        for (std::size_t p = 0; p < state.partitions.size(); ++p) {
            for (const int lane : state.partitions[p].lanes) {
                EXPECT_EQ(partition_of[static_cast<std::size_t>(lane)], -1);
                partition_of[static_cast<std::size_t>(lane)] = static_cast<int>(p);
            }
        }
        for (std::size_t lane = 0; lane < partition_of.size(); ++lane) {
            ASSERT_GE(partition_of[lane], 0);
            for (const Conflict& c : model.graph.conflicts_of(static_cast<int>(lane))) {
                EXPECT_EQ(partition_of[lane], partition_of[static_cast<std::size_t>(c.other)]);
            }
            const int origin = model.graph.lanes[lane].origin;
            if (origin >= 0) {
                EXPECT_EQ(partition_of[lane], partition_of[static_cast<std::size_t>(origin)]);
            }
        }
    }
}

}  // namespace
}  // namespace stopline
