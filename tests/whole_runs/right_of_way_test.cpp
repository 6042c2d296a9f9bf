// Right of way at the reference intersection: accepted gaps, waiting, turning speed, equal legs, no conflicts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "base/containers/index.h"
#include "runs/intersection/intersection_run.h"
#include "scenario/build_model.h"
#include "scenario/load_scenario.h"

namespace stopline {
namespace {

Scenario reference(const std::vector<std::string>& overrides = {}) {
    return load_scenario(STOPLINE_SOURCE_DIR "/scenarios/intersection.yaml", overrides);
}

std::vector<std::string> turn_shares(int left, int right) {
    return {"demand.left=" + std::to_string(left) + " %", "demand.right=" + std::to_string(right) + " %"};
}

// Returns a model in which only the west leg has traffic, and all of it turns left.
Model left_turns_only() {
    Scenario scenario = reference({"demand.left=100 %"});
    Model model = build_model(scenario, 0);
    std::erase_if(model.demand.inlets, [&](const DemandPlan::Inlet& inlet) {
        return model.graph.lanes[at(inlet.lane)].name != "west_in_0";
    });
    return model;
}

TEST(RightOfWay, LeftTurnsDoNotWaitWithoutOncomingTraffic) {
    const Model model = left_turns_only();
    Simulation simulation(model);
    double slowest_mps = 1e9;
    while (simulation.time_s() < 150.0) {
        simulation.step();
        const State& state = simulation.state();
        for (int lane = 0; lane < static_cast<int>(model.graph.lanes.size()); ++lane) {
            if (model.graph.lanes[at(lane)].origin < 0) continue;
            ASSERT_EQ(yield_stops_of(state, lane).count, 0);
            const LaneBlock& block = state.blocks[at(lane)];
            for (int slot = block.first; slot < block.past_last(); ++slot) {
                slowest_mps = std::min(slowest_mps, state.vehicles.speed_mps[at(slot)]);
            }
        }
    }
    EXPECT_GT(slowest_mps, 3.0);
    EXPECT_GT(simulation.state().records.gaps_accepted.size(), 8u);
}

// With a standstill gap of 2.45 m, a vehicle behind a waiting left-turning vehicle stops past the stop line. After the
// signal has turned red, the opposite left-turning vehicle must not wait for this vehicle.
TEST(RightOfWay, QueueBehindALeftTurnDoesNotHoldUpTheOppositeOne) {
    const Scenario scenario =
        reference({"fidelity=meso", "meso={base: fitted, constant_time: {standstill_gap: 2.45 m}}", "demand.left=15 %",
                   "demand.right=10 %", "signal.green=25 s"});
    const Model model = build_model(scenario, 0);
    Simulation simulation(model);
    while (simulation.time_s() < 400.0) simulation.step();
    EXPECT_LT(model.time_s(simulation.state().records.longest_in_junction_ticks), 66.0);  // one cycle
    EXPECT_GT(simulation.state().records.exited, 400);
    EXPECT_TRUE(simulation.state().records.violations.none());
}

TEST(RightOfWay, TurnsKeepTheirSpeedLimit) {
    const Model model = left_turns_only();
    Simulation simulation(model);
    double fastest_mps = 0.0;
    while (simulation.time_s() < 150.0) {
        simulation.step();
        const State& state = simulation.state();
        for (int lane = 0; lane < static_cast<int>(model.graph.lanes.size()); ++lane) {
            if (model.graph.lanes[at(lane)].turn != Turn::left) continue;
            const LaneBlock& block = state.blocks[at(lane)];
            for (int slot = block.first; slot < block.past_last(); ++slot) {
                fastest_mps = std::max(fastest_mps, state.vehicles.speed_mps[at(slot)]);
            }
        }
    }
    EXPECT_GT(fastest_mps, 6.0);
    EXPECT_LT(fastest_mps, 7.0 * 1.1) << "a follower may exceed the limit by 5 %";
}

// After a left-turning vehicle has accepted a gap, the next vehicle with priority reaches the conflict area only after
// GapAccepted::needed_s (less a tolerance of 0.3 s).
TEST(RightOfWay, LeftTurnsUseSufficientGaps) {
    Scenario scenario = reference(turn_shares(15, 10));
    scenario.measure.cycles = 8;
    const Model model = build_model(scenario, 0);
    Simulation simulation(model);
    // [1000 * connection with priority + yielding connection] times at which vehicles with priority reach the conflict
    // area
    std::map<int, std::vector<double>> arrivals_s;
    std::map<int, double> last_front_m;  // [vehicle]
    while (simulation.time_s() < measured_window(scenario).to_s) {
        simulation.step();
        const State& state = simulation.state();
        for (int lane = 0; lane < static_cast<int>(model.graph.lanes.size()); ++lane) {
            if (model.graph.lanes[at(lane)].turn != Turn::straight) continue;
            const LaneBlock& block = state.blocks[at(lane)];
            for (int slot = block.first; slot < block.past_last(); ++slot) {
                const int id = state.vehicles.id[at(slot)];
                const double front_m = state.vehicles.position_m[at(slot)];
                for (const Conflict& c : model.graph.conflicts_of(lane)) {
                    if (c.other_yields && last_front_m[id] < c.from_m && front_m >= c.from_m) {
                        arrivals_s[lane * 1000 + c.other].push_back(simulation.time_s());
                    }
                }
                last_front_m[id] = front_m;
            }
        }
    }
    const std::vector<GapAccepted>& gaps = simulation.state().records.gaps_accepted;
    ASSERT_GT(gaps.size(), 20u);
    int checked = 0;
    for (const GapAccepted& gap : gaps) {
        EXPECT_GE(gap.gap_s, gap.needed_s);
        for (const Conflict& c : model.graph.conflicts_of(gap.lane)) {
            if (!c.yields) continue;
            const std::vector<double>& times = arrivals_s[c.other * 1000 + gap.lane];
            const auto next = std::upper_bound(times.begin(), times.end(), gap.time_s);
            if (next == times.end()) continue;
            ++checked;
            EXPECT_GT(*next - gap.time_s, gap.needed_s - 0.3) << "at " << gap.time_s << " s";
        }
    }
    EXPECT_GT(checked, 30);
}

struct Setting {
    const char* population;
    double green_s;
    int left;
    int right;
};

class SlowIntersection : public testing::TestWithParam<Setting> {};
INSTANTIATE_TEST_SUITE_P(Settings, SlowIntersection,
                         testing::Values(Setting{"CDG", 5, 30, 30}, Setting{"CTG-Ref", 10, 30, 0},
                                         Setting{"P50", 15, 15, 30}, Setting{"CDG", 15, 0, 0},
                                         Setting{"P25", 20, 5, 10}, Setting{"P75", 30, 30, 30}));

TEST_P(SlowIntersection, HasNoConflictsAndNoDeadlocks) {
    Scenario scenario = reference(turn_shares(GetParam().left, GetParam().right));
    scenario.signal.green_s = GetParam().green_s;
    const auto named = [&](const PopulationSettings& p) { return p.name == GetParam().population; };
    const auto population = std::find_if(scenario.populations.begin(), scenario.populations.end(), named);
    const IntersectionResult result =
        run_intersection(scenario, static_cast<std::size_t>(population - scenario.populations.begin()));
    EXPECT_TRUE(result.violations.none());
    EXPECT_EQ(result.violations.conflicts, 0);
    EXPECT_LT(result.longest_in_junction_s, 2.0 * 2.0 * (GetParam().green_s + 8.0)) << "a deadlock";
    // On average, a lane discharges at least one vehicle per green.
    EXPECT_GE(result.discharge.vehicles_per_green, 1.0);
    // The travel time is below 12 cycles. With two vehicles per green, a queue of 25 vehicles takes about this time.
    EXPECT_LT(result.zones[0].travel_time_s, 12.0 * 2.0 * (GetParam().green_s + 8.0));
}

// Regression test: turning vehicles slow CDG platoons down, and yellow splits them. In an earlier version one follower
// closed in on its leader from a gap of only 1.2 m.
TEST(RightOfWay, PlatoonsSplitByYellowDoNotCollide) {
    std::vector<std::string> overrides = turn_shares(10, 20);
    for (const char* setting : {"network.intersection.lanes=[{movements: straight+left+right}]", "signal.green=22 s",
                                "signal.all_red=2 s", "seed=2"}) {
        overrides.emplace_back(setting);
    }
    const Scenario scenario = reference(overrides);
    const Model model = build_model(scenario, scenario.populations.size() - 1);
    Simulation simulation(model);
    while (simulation.time_s() < 180.0) simulation.step();
    EXPECT_TRUE(simulation.state().records.violations.none());
    EXPECT_EQ(simulation.state().records.violations.overlaps, 0);
}

TEST(RightOfWay, EveryEntryLaneDischargesTheSameWithoutTurns) {
    const Scenario scenario = reference();
    const Model model = build_model(scenario, 6);
    Simulation simulation(model);
    // The run covers three whole cycles.
    while (simulation.time_s() < 1.0 + 3.0 * 46.0) simulation.step();
    std::map<int, int> passed;  // [entry lane] vehicles
    for (const Crossing& crossing : simulation.state().records.crossings) {
        const Detector& detector = model.detectors[at(crossing.detector)];
        if (detector.kind == Detector::Kind::stop_line) ++passed[detector.lane];
    }
    ASSERT_EQ(passed.size(), 8u);
    for (const auto& [lane, vehicles] : passed) {
        EXPECT_EQ(vehicles, passed.begin()->second) << model.graph.lanes[at(lane)].name;
    }
}

// Left-turning vehicles wait inside for oncoming traffic, and vehicles behind them keep a standstill gap of 6 m. When
// the signal is red again, the left-turning vehicles must not wait for an oncoming vehicle that is itself stuck behind
// one of them.
TEST(LongStandstillGaps, DoNotLockOpposedLeftTurners) {
    const Scenario scenario = parse_scenario(R"(
seed: 665
step: 20 ms
network:
  kind: intersection
  intersection:
    lanes: [{movements: left}, {movements: straight+left}, {movements: straight+right}]
    radius: 22 m
    approach_length: 280 m
    exit_length: 101 m
    speed_limit: 30 km/h
    turn_speed: 7 m/s
signal: {green: 22 s, all_red: 1 s}
demand: {left: 20 %}
driver: {base: startup_kit, free_drive: {hesitation: 1 s}}
populations: [CDG-6m]
)",
                                             "test.yaml");
    const IntersectionResult result = run_intersection(scenario, 0);
    EXPECT_GT(result.left_share, 0.1);
    EXPECT_TRUE(result.violations.none());
    EXPECT_EQ(result.violations.deadlocks, 0);
}

// Articulated lorries from crossing streets meet inside the intersection after a short all-red time. A lorry that turns
// left must not stop behind a second lorry if its rear then blocks a third lorry that the second one waits for.
TEST(LongVehicles, DoNotStandInEachOthersPath) {
    const Scenario scenario = parse_scenario(R"(
seed: 526
step: 20 ms
duration: 400 s
network:
  kind: intersection
  intersection:
    lanes: [{movements: left}, {movements: straight+left}, {movements: straight+right}]
    radius: 30 m
    approach_length: 92 m
    exit_length: 100 m
    speed_limit: 30 km/h
    turn_speed: 9 m/s
signal: {green: 10 s, yellow: 5 s, all_red: 1 s}
demand: {kind: rate, inflow: 3450 veh/h, left: 20 %, right: 10 %}
driver: {base: startup_kit, free_drive: {hesitation: 0 s}}
populations:
- name: X
  pattern: balanced
  components: [{policy: CDG-6m, share: 100 %, vehicle: articulated_lorry_35t, driver: lorry}]
)",
                                             "test.yaml");
    const IntersectionResult result = run_intersection(scenario, 0);
    EXPECT_TRUE(result.violations.none());
    EXPECT_EQ(result.violations.deadlocks, 0);
    EXPECT_GT(result.throughput_veh_h, 1100.0);
}

// Lorries meet while they drive: a left-turning lorry from the north reaches the path of a lorry from the south, which
// can no longer stop before the path of a lorry from the east. The rear of the latter blocks the exit of the first one.
// So the lorry from the north must wait until the one from the south has passed.
TEST(LongVehicles, DoNotDriveIntoEachOthersPath) {
    const Scenario scenario = parse_scenario(R"(
seed: 619
step: 20 ms
duration: 400 s
network:
  kind: intersection
  intersection:
    lanes: [{movements: left}, {movements: straight+right}]
    radius: 23 m
    approach_length: 174 m
    exit_length: 97 m
    speed_limit: 70 km/h
    turn_speed: 6 m/s
signal: {green: 12 s, yellow: 4 s, all_red: 1 s}
demand: {kind: rate, inflow: 1816 veh/h, right: 0 %}
driver: {base: startup_kit, free_drive: {hesitation: 0.5 s}}
populations:
- name: X
  pattern: random
  components:
  - {policy: CTG-Ref, share: 34 %, vehicle: rigid_lorry_12t, driver: lorry}
  - {policy: CTG-Ref, share: 33 %, vehicle: articulated_lorry_35t, driver: lorry}
  - {policy: CTG-Ref, share: 33 %, vehicle: articulated_lorry_35t, driver: lorry}
)",
                                             "test.yaml");
    int kept_out_steps = 0;  // vehicle steps in which a driving lorry must not close a cycle
    const auto count = [&](const Simulation& simulation) {
        const State& state = simulation.state();
        for (int lane = 0; lane < state.plan.lanes(); ++lane) {
            const YieldStops& stops = yield_stops_of(state, lane);
            for (int k = 0; k < stops.count; ++k) {
                const YieldStop& stop = stops.stops[at(k)];
                const bool is_driving = state.vehicles.speed_mps[at(stop.slot)] > 1.0;
                if (stop.reason == YieldReason::deadlock && is_driving) ++kept_out_steps;
            }
        }
        return true;
    };
    const IntersectionResult result = run_intersection(scenario, 0, count);
    EXPECT_TRUE(result.violations.none());
    EXPECT_EQ(result.violations.deadlocks, 0);
    EXPECT_GT(result.throughput_veh_h, 900.0);
    EXPECT_GT(kept_out_steps, 10);
}

// Left-turning lorries from four sides meet. The two from the east and the west arrive at the same time and at the same
// speed, and each of them could close the cycle of four.
TEST(LongVehicles, OfFourLeftTurnersOneWaits) {
    const Scenario scenario = parse_scenario(R"(
seed: 86
step: 20 ms
duration: 400 s
network:
  kind: intersection
  intersection:
    lanes: [{movements: left}, {movements: straight+right}]
    radius: 23 m
    approach_length: 297 m
    exit_length: 51 m
    speed_limit: 30 km/h
    turn_speed: 6 m/s
signal: {green: 12 s, yellow: 3 s, all_red: 1 s}
demand: {kind: rate, inflow: 701 veh/h, right: 10 %}
driver: {base: startup_kit, free_drive: {hesitation: 0 s}}
populations:
- name: X
  pattern: random
  components: [{policy: CTG-HCM, share: 100 %, vehicle: articulated_lorry_35t, driver: lorry}]
)",
                                             "test.yaml");
    const IntersectionResult result = run_intersection(scenario, 0);
    EXPECT_TRUE(result.violations.none());
    EXPECT_EQ(result.violations.deadlocks, 0);
    EXPECT_GT(result.throughput_veh_h, 700.0);
}

}  // namespace
}  // namespace stopline
