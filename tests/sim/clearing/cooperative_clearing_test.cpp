// Cooperative clearing: a vehicle is admitted to an intersection only if there is room for it beyond the conflict area.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "base/containers/index.h"
#include "base/speed_thresholds.h"
#include "scenario/build_model.h"
#include "scenario/load_scenario.h"
#include "sim/clearing/exit_booking.h"
#include "sim/step/simulation.h"

namespace stopline {
namespace {

Model grid(std::vector<std::string> overrides) {
    for (const char* const common : {"rules.pass_blocker_greens=0", "rules.teleport_cycles=1000"})
        overrides.insert(overrides.begin(), common);
    return build_model(load_scenario(STOPLINE_SOURCE_DIR "/scenarios/grid.yaml", overrides), 0);
}

std::string population(const std::string& policy) { return "populations=[" + policy + "]"; }

class BothFidelities : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Clearing, BothFidelities, testing::Values("meso", "full"),
                         [](const auto& run) { return std::string(run.param); });

// A block of 192.5 m with stop lines 20 m from the centres has 152.5 m before the stop line. The first vehicle rests 1
// m before the line, and the last one must rest 1 m beyond the conflict area. With a length of 5.15 m and a standstill
// gap of 2.95 m, (150.5 - 5.15) / 8.1 + 1 = 18.9 vehicles fit. 60 s of green would let 70 vehicles pass.
TEST_P(BothFidelities, EighteenVehiclesFitIntoABlockBeforeARedLight) {
    for (const std::string policy : {"CDG", "CTG-Ref"}) {
        const Model model =
            grid({population(policy), "measure.baseline=" + policy, "rules.clearing=cooperative",
                  "network.grid.columns=2", "network.grid.rows=1", "network.grid.column_spacing=192.5 m",
                  "demand.left=0 %", "demand.right=0 %", "signal.green=60 s", "signal.offset=68 s", "duration=2000 s",
                  "measure.window=600 s", std::string("fidelity=") + GetParam()});
        Simulation simulation(model);
        simulation.run_until(64.0);
        const State& state = simulation.state();
        int full_lanes = 0;
        for (const int link : model.graph.links) {
            if (state.plan.lane(link).signal_group != 2) continue;  // eastbound lanes before the second intersection
            const LaneBlock& block = state.blocks[at(link)];
            EXPECT_EQ(block.count, 18) << policy;
            ++full_lanes;
            if (block.count == 0) continue;
            EXPECT_GE(state.vehicles.position_m[at(block.last())], state.vehicles.length_m[at(block.last())]);
            for (const int connection : model.connections_to.of(link))
                EXPECT_EQ(state.blocks[at(connection)].count, 0) << "vehicles inside the intersection";
        }
        EXPECT_EQ(full_lanes, 2);
        EXPECT_GE(state.congestion.delays.refused, 2);
        EXPECT_GT(state.congestion.delays.refusal_ticks, 0);
        EXPECT_TRUE(state.records.violations.none());
    }
}

// The block is full when its signal becomes green, and the signal upstream is green at that time. A vehicle that enters
// at once would crawl inside the intersection, because the last vehicle of the queue starts many time gaps later.
TEST_P(BothFidelities, AVehicleWaitsUntilTheQueueOnItsExitLaneStarts) {
    constexpr double kDownstreamGreen_s = 61.0;
    constexpr double kUpstreamRed_s = 81.0;
    const Model model = grid({population("CTG-Ref"), "measure.baseline=CTG-Ref", "rules.clearing=cooperative",
                              "network.grid.columns=2", "network.grid.rows=1", "network.grid.column_spacing=192.5 m",
                              "demand.left=0 %", "demand.right=0 %", "signal.green=80 s", "signal.offset=60 s",
                              "duration=2000 s", "measure.window=600 s", std::string("fidelity=") + GetParam()});
    Simulation simulation(model);
    int waiting = 0;
    int entered = 0;
    while (simulation.time_s() < kUpstreamRed_s) {
        const bool is_full = simulation.time_s() > kDownstreamGreen_s - 1.0;
        simulation.step();
        const State& state = simulation.state();
        for (const int link : model.graph.links) {
            if (state.plan.lane(link).signal_group != 2) continue;
            for (const int connection : model.connections_to.of(link)) {
                const LaneBlock& block = state.blocks[at(connection)];
                for (int slot = block.first; slot < block.past_last(); ++slot) {
                    EXPECT_GE(state.vehicles.speed_mps[at(slot)], kCrawlingSpeed_mps) << simulation.time_s() << " s";
                    entered += is_full ? 1 : 0;
                }
                const StopLineState& line = state.stop_lines.lines[at(state.plan.lane(connection).origin)];
                waiting += is_full && line.keep_clear_vehicle >= 0 ? 1 : 0;
            }
        }
    }
    EXPECT_GT(waiting, 0);
    EXPECT_GT(entered, 0);
    EXPECT_TRUE(simulation.state().records.violations.none());
}

struct Outcome {
    std::int64_t stops = 0;              // vehicle steps with a stop in a conflict area
    std::int64_t exit_stops = 0;         // the same without those of yielding vehicles and of the vehicles behind them
    std::int64_t admitted = 0;           // vehicles
    std::int64_t stops_of_admitted = 0;  // vehicle steps of admitted vehicles with a stop in a conflict area
    std::int64_t refused = 0;
    std::int64_t keep_clear = 0;  // uses of the keep-clear rule
    std::int64_t exited = 0;
    std::size_t gridlocks = 0;
};

// Returns true if the vehicle in `slot` is stopped in a conflict area. `front_m`: its front from the start of the
// connection.
bool stops_in_conflict_area(const State& state, int connection, int slot, double front_m) {
    if (state.vehicles.speed_mps[at(slot)] >= kStoppedSpeed_mps) return false;
    const double rear_m = front_m - state.vehicles.length_m[at(slot)];
    const auto conflicts = state.plan.conflicts(connection);
    return std::any_of(conflicts.begin(), conflicts.end(),
                       [&](const Conflict& conflict) { return front_m > conflict.from_m && rear_m < conflict.to_m; });
}

// Returns true if the vehicle in `slot` or a vehicle ahead of it on the same lane yields to another vehicle.
bool waits_to_yield(const State& state, const LaneBlock& block, int slot) {
    constexpr int kStartTicks = 10;  // 1 s, in which the vehicle starts again
    for (int k = block.first; k <= slot; ++k) {
        if (state.vehicles.record[at(k)].yield_tick >= state.tick - kStartTicks) return true;
    }
    return false;
}

// Adds the vehicles with V2V that are admitted and have not passed their stop line yet.
void add_admitted(const State& state, std::set<int>& admitted) {
    for (int lane = 0; lane < state.plan.lanes(); ++lane) {
        if (state.clearing.last_admitted[at(lane)] < 0) continue;
        const int end = admitted_end(state, lane);
        for (int slot = state.blocks[at(lane)].first; slot < end; ++slot) {
            if (has_v2v(state, slot)) admitted.insert(state.vehicles.id[at(slot)]);
        }
    }
}

// Counts the vehicles that are stopped in a conflict area.
void count_stops(const State& state, const std::set<int>& admitted, Outcome& outcome) {
    const VehicleArrays& v = state.vehicles;
    const auto count = [&](const LaneBlock& block, int connection, int slot, double front_m) {
        if (!stops_in_conflict_area(state, connection, slot, front_m)) return;
        ++outcome.stops;
        outcome.stops_of_admitted += admitted.contains(v.id[at(slot)]) ? 1 : 0;
        if (!waits_to_yield(state, block, slot)) ++outcome.exit_stops;
    };
    for (int lane = 0; lane < state.plan.lanes(); ++lane) {
        const LaneBlock& block = state.blocks[at(lane)];
        for (int slot = block.first; slot < block.past_last(); ++slot) {
            const double front_m = v.position_m[at(slot)];
            const int previous = v.record[at(slot)].previous_lane;
            if (state.plan.lane(lane).origin >= 0) {
                count(block, lane, slot, front_m);
            } else if (front_m < v.length_m[at(slot)] && previous >= 0 && state.plan.lane(previous).origin >= 0) {
                count(block, previous, slot, state.plan.lane(previous).length_m + front_m);
            }
        }
    }
}

Outcome run(const std::vector<std::string>& overrides, double until_s) {
    const Model model = grid(overrides);
    Simulation simulation(model);
    Outcome outcome;
    std::set<int> admitted;
    while (simulation.time_s() < until_s) {
        simulation.step();
        if (model.rules.clearing) add_admitted(simulation.state(), admitted);
        count_stops(simulation.state(), admitted, outcome);
    }
    outcome.admitted = static_cast<std::int64_t>(admitted.size());
    const State& state = simulation.state();
    EXPECT_TRUE(state.records.violations.none());
    EXPECT_EQ(state.records.violations.conflicts, 0);
    outcome.refused = state.congestion.delays.refused;
    outcome.exited = state.records.exited;
    outcome.gridlocks = state.congestion.delays.gridlocks.size();
    for (const RuleUse& use : state.congestion.delays.rule_uses)
        outcome.keep_clear += use.kind == RuleUse::Kind::keep_clear ? 1 : 0;
    return outcome;
}

std::vector<std::string> small_grid(const std::string& policy, const std::string& clearing) {
    return {population(policy),       "measure.baseline=" + policy, "rules.clearing=" + clearing,
            "network.grid.columns=3", "network.grid.rows=3",        "signal.green=20 s",
            "demand.left=0 %",        "demand.right=20 %"};
}

// Without left turns no vehicle yields inside the intersections, so that only a full exit lane could stop a vehicle
// there. The same vehicles without V2V stop inside.
TEST(Clearing, AnAdmittedVehicleNeverStopsInAConflictArea) {
    for (const std::string policy : {"CDG", "SWITCH-1"}) {
        const Outcome outcome = run(small_grid(policy, "cooperative"), 1500.0);
        EXPECT_EQ(outcome.stops, 0) << policy;
        EXPECT_GT(outcome.admitted, 1000) << policy;
        EXPECT_GT(outcome.refused, 200) << policy;
    }
    EXPECT_GT(run(small_grid("CDG", "off"), 600.0).stops, 500);
}

TEST(SlowClearing, AnAdmittedVehicleNeverStopsInAConflictAreaInFullDynamics) {
    std::vector<std::string> overrides = small_grid("CDG", "cooperative");
    overrides.emplace_back("fidelity=full");
    const Outcome outcome = run(overrides, 400.0);
    EXPECT_EQ(outcome.stops, 0);
    EXPECT_GT(outcome.refused, 50);
}

std::vector<std::string> small_grid_with_channel(const std::string& fidelity, std::vector<std::string> channel) {
    std::vector<std::string> overrides = small_grid("CDG", "cooperative");
    overrides.push_back("fidelity=" + fidelity);
    for (std::string& setting : channel) overrides.push_back("driver.v2v." + setting);
    return overrides;
}

// Messages are late, but none is lost.
TEST(ClearingChannel, AnAdmittedVehicleNeverStopsInAConflictAreaIfNoMessageIsLost) {
    const Outcome outcome =
        run(small_grid_with_channel("meso", {"channel=bernoulli", "loss=0 %", "interval=0.2 s"}), 1500.0);
    EXPECT_EQ(outcome.stops_of_admitted, 0);
    EXPECT_GT(outcome.admitted, 1000);
    EXPECT_GT(outcome.refused, 200);
    EXPECT_EQ(outcome.keep_clear, 0);
}

TEST(SlowClearingChannel, AnAdmittedVehicleNeverStopsInAConflictAreaInFullDynamics) {
    const Outcome outcome =
        run(small_grid_with_channel("full", {"channel=bernoulli", "loss=0 %", "interval=0.1 s"}), 300.0);
    EXPECT_EQ(outcome.stops_of_admitted, 0);
    EXPECT_GT(outcome.admitted, 200);
    EXPECT_GT(outcome.refused, 30);
}

// A vehicle without a message of the last second falls back to the keep-clear rule. With one message a second and a
// loss of 50 %, this happens often. With a range of 2 m, a vehicle can only be refused because vehicles of its own lane
// have booked an exit lane that is still empty.
TEST(ClearingChannel, WithoutRecentMessagesTheKeepClearRuleApplies) {
    const Outcome rare =
        run(small_grid_with_channel("meso", {"channel=bernoulli", "loss=50 %", "interval=1 s"}), 800.0);
    EXPECT_GT(rare.keep_clear, 50);
    EXPECT_GT(rare.refused, 50);
    const Outcome never = run(small_grid_with_channel("meso", {"channel=bernoulli", "loss=0 %", "range=2 m"}), 800.0);
    EXPECT_GT(never.keep_clear, 50);
    EXPECT_LT(never.refused, never.keep_clear / 3);
}

TEST(ClearingChannel, AnyNumberOfThreadsGivesTheSameRun) {
    const Model model = grid({population("CDG"), "measure.baseline=CDG", "rules.clearing=cooperative",
                              "signal.green=20 s", "driver.v2v.channel=gilbert", "driver.v2v.loss=20 %"});
    std::set<std::uint64_t> hashes;
    for (const int threads : {1, 2, 4}) {
        Simulation simulation(model, threads);
        simulation.run_until(200.0);
        EXPECT_GT(simulation.state().congestion.delays.refused, 50);
        hashes.insert(simulation.state_hash());
    }
    EXPECT_EQ(hashes.size(), 1u);
}

// One driver of five has no V2V. They obey the keep-clear rule.
TEST(Clearing, VehiclesWithoutV2vKeepTheKeepClearRule) {
    const std::string mixed =
        "{name: MIXED, pattern: balanced, components: [{policy: CDG, share: 80 %}, {policy: HUMAN, share: 20 %}]}";
    std::vector<std::string> overrides = small_grid(mixed, "cooperative");
    overrides[1] = "measure.baseline=MIXED";
    const Outcome outcome = run(overrides, 1000.0);
    EXPECT_GT(outcome.refused, 20);
    EXPECT_GT(outcome.keep_clear, 15);
    EXPECT_GT(outcome.exited, 1000);
}

// The junctions of this grid block each other without V2V.
TEST(Clearing, PreventsGridlocksWithTurns) {
    std::vector<std::string> overrides = small_grid("CDG", "cooperative");
    overrides.insert(overrides.end(),
                     {"network.grid.columns=5", "network.grid.rows=5", "demand.left=5 %", "demand.right=10 %"});
    const Outcome with = run(overrides, 1200.0);
    overrides[2] = "rules.clearing=off";
    const Outcome without = run(overrides, 1200.0);
    EXPECT_EQ(with.gridlocks, 0u);
    EXPECT_EQ(with.exit_stops, 0);
    EXPECT_GT(without.exit_stops, 5000);
    EXPECT_GT(without.gridlocks, 0u);
    EXPECT_GT(static_cast<double>(with.exited), 1.5 * static_cast<double>(without.exited));
}

TEST(Clearing, AnyNumberOfThreadsGivesTheSameRun) {
    const Model model =
        grid({population("CDG"), "measure.baseline=CDG", "rules.clearing=cooperative", "signal.green=20 s"});
    std::set<std::uint64_t> hashes;
    for (const int threads : {1, 2, 4}) {
        Simulation simulation(model, threads);
        simulation.run_until(300.0);
        EXPECT_GT(simulation.state().congestion.delays.refused, 100);
        hashes.insert(simulation.state_hash());
    }
    EXPECT_EQ(hashes.size(), 1u);
}

}  // namespace
}  // namespace stopline
