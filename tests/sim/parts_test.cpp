// One run shared by several threads: a network in which queues block intersections, circles form, vehicles are moved on and pass
// blockers, gives the same bits and the same events whatever the number of threads, and as with one vehicle at a time, where
// nobody who rests is left out.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "scenario/build_model.h"
#include "scenario/load_scenario.h"
#include "sim/step/simulation.h"

namespace stopline {
namespace {

// Streets so short and turns so many that it locks up within minutes.
Model crowded(const std::string& fidelity, int population, const std::string& meso = "passages") {
    const Scenario scenario =
        load_scenario(STOPLINE_SOURCE_DIR "/scenarios/grid.yaml",
                      {"fidelity=" + fidelity, "meso=" + meso, "network.grid.columns=3", "network.grid.rows=3",
                       "network.grid.column_spacing=150 m", "network.grid.row_spacing=150 m", "demand.left=15 %",
                       "rules.teleport_cycles=1", "rules.pass_blocker_greens=0.5", "signal.green=20 s",
                       "network.intersection.approach_length=150 m"});
    return build_model(scenario, static_cast<std::size_t>(population));
}

// All that a run tells, as text.
std::vector<std::string> told(const State& state) {
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
    for (const double lost_s : state.congestion.delays.delay_s) lines.push_back("lost " + std::to_string(lost_s));
    lines.push_back("longest " + std::to_string(state.records.longest_in_junction) + ", updates " + std::to_string(state.records.updates));
    return lines;
}

void expect_same(Simulation& one, Simulation& other, double until_s, double every_s, const std::string& what) {
    for (int k = 1; k * every_s <= until_s; ++k) {
        one.run_until(k * every_s);
        other.run_until(k * every_s);
        ASSERT_EQ(one.state_hash(), other.state_hash()) << what << ": first difference before " << k * every_s << " s";
    }
    ASSERT_EQ(told(one.state()), told(other.state())) << what;
    EXPECT_TRUE(one.state().records.violations.none());
    EXPECT_TRUE(other.state().records.violations.none());
}

TEST(Parts, AnyNumberOfThreadsGivesTheSameRun) {
    for (const int population : {1, 2}) {
        const Model model = crowded("meso", population);
        for (const int threads : {2, 3}) {  // more than there are processors would wait for each other for long
            Simulation alone(model);
            Simulation shared(model, threads);
            expect_same(alone, shared, 400.0, 20.0, std::to_string(threads) + " threads");
            if (population < 2) continue;
            EXPECT_GT(alone.state().congestion.delays.teleported, 0);
        }
    }
}

// Ways that meet no other have parts of their own.
TEST(Parts, WaysWithoutConflictsAreInTheAccountToo) {
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
    EXPECT_GT(model.time_s(alone.state().records.longest_in_junction), 10.0);
}

TEST(Parts, InFullDynamicsToo) {
    const Model model = crowded("full", 2);
    Simulation alone(model);
    Simulation shared(model, 2);
    expect_same(alone, shared, 60.0, 10.0, "full dynamics");
}

TEST(Resting, ChangesNothing) {
    for (const char* const meso : {"fitted", "passages"}) {  // in the second, queues hear of starts by V2V
        for (const int population : {0, 1, 2}) {
            const Model model = crowded("meso", population, meso);
            Model oracle = model;
            oracle.scalar_kernels = true;
            Simulation fast(model);
            Simulation each_by_itself(oracle);
            expect_same(fast, each_by_itself, 500.0, 10.0, std::string("oracle, ") + meso);
        }
    }
}

// Slots without a vehicle say so, and on a sleeping lane somebody waits for the light.
TEST(Slots, WithoutAVehicleHaveNoId) {
    const Model model = crowded("meso", 2);
    Simulation simulation(model, 2);
    bool slept = false;
    while (simulation.time_s() < 300.0) {
        for (int k = 0; k < 37; ++k) simulation.step();
        const State& state = simulation.state();
        std::vector<bool> taken(static_cast<std::size_t>(state.vehicles.slots), false);
        const auto take = [&](const LaneBlock& block) {
            for (int slot = block.first; slot < block.past_last(); ++slot) taken[static_cast<std::size_t>(slot)] = true;
        };
        for (const LaneBlock& block : state.blocks) take(block);
        take(state.congestion.teleporting);
        for (std::size_t slot = 0; slot < taken.size(); ++slot) ASSERT_EQ(state.vehicles.id[slot] >= 0, taken[slot]);
        for (std::size_t lane = 0; lane < state.blocks.size(); ++lane) {
            if (state.queues.sleeps_until_green[lane] < 0) continue;
            slept = true;
            const LaneBlock& block = state.blocks[lane];
            EXPECT_EQ(state.stop_lines.lines[lane].stopping_vehicle, state.vehicles.id[static_cast<std::size_t>(block.first)]);
            EXPECT_EQ(state.vehicles.speed_mps[static_cast<std::size_t>(block.first)], 0.0);
            EXPECT_EQ(state.stop_lines.stop_slot[lane], block.first);
        }
    }
    EXPECT_TRUE(slept);
}

// Nobody is left out who could be in two parts, or in none.
TEST(Parts, ShareOutAllLanesByWholeIntersections) {
    const Model model = crowded("meso", 0);
    for (const int threads : {1, 2, 4, 9, 30}) {
        const Simulation simulation(model, threads);
        const State& state = simulation.state();
        EXPECT_LE(state.partitions.size(), static_cast<std::size_t>(std::min(threads, 9)));
        std::vector<int> part_of(model.graph.lanes.size(), -1);
        for (std::size_t p = 0; p < state.partitions.size(); ++p) {
            for (const int lane : state.partitions[p].lanes) {
                EXPECT_EQ(part_of[static_cast<std::size_t>(lane)], -1);
                part_of[static_cast<std::size_t>(lane)] = static_cast<int>(p);
            }
        }
        for (std::size_t lane = 0; lane < part_of.size(); ++lane) {
            ASSERT_GE(part_of[lane], 0);
            for (const Conflict& c : model.graph.conflicts_of(static_cast<int>(lane))) {
                EXPECT_EQ(part_of[lane], part_of[static_cast<std::size_t>(c.other)]);
            }
            const int origin = model.graph.lanes[lane].origin;
            if (origin >= 0) {
                EXPECT_EQ(part_of[lane], part_of[static_cast<std::size_t>(origin)]);
            }
        }
    }
}

}  // namespace
}  // namespace stopline
