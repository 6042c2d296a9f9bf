// Traffic rules in whole runs: teleporting, passing of blockers and the keep-clear rule.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "runs/network/network_run.h"
#include "scenario/load_scenario.h"
#include "sim/step/simulation.h"

namespace stopline {
namespace {

Scenario arterial(const std::vector<std::string>& overrides) {
    return load_scenario(STOPLINE_SOURCE_DIR "/scenarios/arterial.yaml", overrides);
}

struct Run {
    const char* fidelity;
    double until_s;
};
void PrintTo(const Run& run, std::ostream* out) { *out << run.fidelity; }
class SlowRules : public testing::TestWithParam<Run> {};
INSTANTIATE_TEST_SUITE_P(Fidelities, SlowRules, testing::Values(Run{"meso", 1200.0}, Run{"full", 400.0}),
                         [](const auto& run) { return std::string(run.param.fidelity); });

// Returns true if the lane is the present lane of the vehicle, its next lane, or one of the two lanes before the
// present one.
bool uses_lane(const State& state, int vehicle, int lane) {
    for (std::size_t k = 0; k < state.blocks.size(); ++k) {
        for (int slot = state.blocks[k].first; slot < state.blocks[k].past_last(); ++slot) {
            const auto i = static_cast<std::size_t>(slot);
            if (state.vehicles.id[i] != vehicle) continue;
            const VehicleRecord& record = state.vehicles.record[i];
            return static_cast<int>(k) == lane || state.vehicles.next_lane[i] == lane || record.previous_lane == lane ||
                   record.second_previous_lane == lane;
        }
    }
    return false;
}

TEST(PassedBlocker, IsRecordedWithALaneOfThePassingVehicle) {
    const Model model =
        network_model(load_scenario(STOPLINE_SOURCE_DIR "/scenarios/grid.yaml",
                                    {"signal.green=20 s", "demand.left=10 %", "demand.right=30 %", "rules.sight=30 m",
                                     "network.grid.columns=3", "network.grid.rows=3"}),
                      2);
    Simulation simulation(model);
    std::size_t checked = 0;
    int passed = 0;
    for (double time_s = 0.0; time_s < 900.0; time_s += model.step_s) {
        simulation.step();
        const std::vector<RuleUse>& rules = simulation.state().congestion.delays.rule_uses;
        for (; checked < rules.size(); ++checked) {
            if (rules[checked].kind != RuleUse::Kind::passed_blocker) continue;
            ++passed;
            EXPECT_TRUE(uses_lane(simulation.state(), rules[checked].vehicle, rules[checked].lane))
                << rules[checked].time_s;
        }
    }
    EXPECT_GT(passed, 20);
}

// Checks every use of a rule on a grid that gridlocks.
TEST_P(SlowRules, ApplyOnlyUnderTheirConditions) {
    const Scenario scenario =
        load_scenario(STOPLINE_SOURCE_DIR "/scenarios/grid.yaml",
                      {std::string("fidelity=") + GetParam().fidelity, "signal.green=20 s", "demand.left=10 %",
                       "demand.right=30 %", "rules.sight=30 m", "network.grid.columns=3", "network.grid.rows=3"});
    const Model model = network_model(scenario, 2);
    Simulation simulation(model);
    simulation.run_until(GetParam().until_s);
    const State& state = simulation.state();
    EXPECT_TRUE(state.records.violations.none());
    EXPECT_EQ(state.records.violations.conflicts, 0);
    EXPECT_EQ(state.records.entered, state.records.exited + state.present());
    const double cycle_s = scenario.nominal_cycle().cycle_s;
    std::set<int> teleporting;
    std::int64_t passed = 0;
    for (const RuleUse& use : state.congestion.delays.rule_uses) {
        if (use.kind == RuleUse::Kind::passed_blocker) {
            ++passed;
            EXPECT_GE(use.stopped_s, 2.0 * scenario.signal.green_s - 1e-6);
        } else if (use.kind == RuleUse::Kind::teleported) {
            EXPECT_GE(use.stopped_s, 3.0 * cycle_s - 1e-6);
            EXPECT_TRUE(teleporting.insert(use.vehicle).second) << "teleported twice";
        } else if (use.kind == RuleUse::Kind::reinserted) {
            EXPECT_EQ(teleporting.erase(use.vehicle), 1u) << "reinserted without a teleport";
        }
    }
    EXPECT_EQ(passed, state.congestion.delays.passed_blockers);
    EXPECT_EQ(static_cast<int>(teleporting.size()), state.congestion.teleporting.count)
        << "vehicles that wait for reinsertion";
    EXPECT_GT(state.congestion.delays.episodes.size(), 20u);
    if (GetParam().until_s > 1000.0) {
        EXPECT_GT(state.congestion.delays.teleported, 0);
        EXPECT_GT(passed, 0);
        EXPECT_FALSE(state.congestion.delays.gridlocks.empty());
    }
    // No vehicle waits forever: the first vehicle of a lane is teleported after a stop of three cycles, and its
    // followers move up.
    EXPECT_LT(state.congestion.delays.longest_stop_s, 10.0 * cycle_s);
}

// Returns the longest time for which a vehicle inside the intersection has been stopped at the end of the run, s.
double longest_stop_inside_s(const std::string& scenario, const std::string& keep_clear) {
    const Model model = network_model(parse_scenario(scenario, "test.yaml", {"rules.keep_clear=" + keep_clear}), 0);
    Simulation simulation(model);
    simulation.run_until(400.0);
    const State& state = simulation.state();
    EXPECT_TRUE(state.records.violations.none());
    double longest_s = 0.0;
    for (std::size_t lane = 0; lane < state.blocks.size(); ++lane) {
        if (state.plan.lane(static_cast<int>(lane)).origin < 0) continue;
        for (int slot = state.blocks[lane].first; slot < state.blocks[lane].past_last(); ++slot) {
            const auto i = static_cast<std::size_t>(slot);
            if (state.vehicles.speed_mps[i] > 0.1) continue;
            longest_s = std::max(longest_s, model.time_s(state.tick - state.vehicles.stopped_since_tick[i]));
        }
    }
    return longest_s;
}

// Many left-turning vehicles wait inside the intersection, and they cannot all leave it during the all-red time of 1 s.
// A random search found this run.
TEST(KeepClear, VehiclesThatWaitInsideLeaveBeforeCrossingOnesEnter) {
    const std::string scenario = R"(
fidelity: meso
step: 20 ms
duration: 400 s
seed: 2
network:
  kind: intersection
  intersection: {radius: 25 m, approach_length: 113 m, exit_length: 185 m, speed_limit: 30 km/h, turn_speed: 9 m/s}
signal: {green: 28 s, yellow: 3 s, all_red: 1 s}
demand: {kind: saturated, left: 40 %, right: 10 %}
policies: []
populations: [CDG]
vehicle: electric_100kw
driver: {base: startup_kit, free_drive: {hesitation: 1 s}}
)";
    const double cycle_s = 2.0 * (28.0 + 3.0 + 1.0);
    EXPECT_GT(longest_stop_inside_s(scenario, "off"), 2.0 * cycle_s) << "without the rule the intersection locks";
    EXPECT_LT(longest_stop_inside_s(scenario, "on"), cycle_s);
}

TEST(SlowKeepClear, ReducesGridlockAndPassedBlockers) {
    std::vector<double> blocked_s;
    for (const char* rule : {"rules.keep_clear=off", "rules.keep_clear=on"}) {
        const Model model = network_model(arterial({rule, "network.grid.columns=3"}), 2);
        Simulation simulation(model);
        simulation.run_until(900.0);
        EXPECT_TRUE(simulation.state().records.violations.none());
        const auto& delay_s = simulation.state().congestion.delays.delay_s;
        blocked_s.push_back(delay_s[static_cast<std::size_t>(DelayCause::gridlock)] +
                            static_cast<double>(simulation.state().congestion.delays.passed_blockers));
    }
    EXPECT_LT(blocked_s[1], 0.5 * blocked_s[0]);
}

// Because of the signal offsets, vehicles in the exit lane drive toward a signal that is already red. The rule counts
// these vehicles as stopped, so drivers behind them do not enter the junction without room in the exit lane.
TEST(SlowKeepClear, CountingTheQueueAtARedExitReducesBlocking) {
    std::vector<double> blocked_s;
    for (const char* rule : {"rules.count_queue_at_red_exit=off", "rules.count_queue_at_red_exit=on"}) {
        const Scenario grid = load_scenario(STOPLINE_SOURCE_DIR "/scenarios/grid.yaml",
                                            {rule, "network.grid.columns=3", "network.grid.rows=3", "demand.left=0 %",
                                             "demand.right=0 %", "signal.green=20 s", "signal.offset=5 s"});
        const Model model = network_model(grid, 2);
        Simulation simulation(model);
        simulation.run_until(900.0);
        EXPECT_TRUE(simulation.state().records.violations.none());
        blocked_s.push_back(
            simulation.state().congestion.delays.delay_s[static_cast<std::size_t>(DelayCause::junction_blocking)]);
    }
    EXPECT_GT(blocked_s[0], 1000.0);
    EXPECT_LT(blocked_s[1], 0.2 * blocked_s[0]);
}

// Drivers who brake late for stop lines obey the keep-clear rule too.
TEST(SlowKeepClear, HoldsDriversWhoBrakeLate) {
    for (const char* fidelity : {"fidelity=meso", "fidelity=full"}) {
        for (const char* stop : {"driver.stop.deceleration=2.5 m/s2", "driver.stop.deceleration=4.7 m/s2"}) {
            const Scenario grid =
                load_scenario(STOPLINE_SOURCE_DIR "/scenarios/grid.yaml",
                              {fidelity, stop, "network.grid.columns=3", "network.grid.rows=3", "demand.left=0 %",
                               "demand.right=0 %", "signal.green=20 s", "signal.offset=15 s"});
            const Model model = network_model(grid, 2);
            Simulation simulation(model);
            simulation.run_until(600.0);
            const State& state = simulation.state();
            EXPECT_TRUE(state.records.violations.none());
            EXPECT_LT(state.congestion.delays.delay_s[static_cast<std::size_t>(DelayCause::junction_blocking)], 200.0)
                << fidelity << ' ' << stop;
        }
    }
}

}  // namespace
}  // namespace stopline
