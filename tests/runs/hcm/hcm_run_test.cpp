// The report by the Highway Capacity Manual in runs: capacity against counts, delay against the closed form, and no
// effect on a run.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "runs/hcm/hcm_tables.h"
#include "runs/intersection/intersection_run.h"
#include "runs/network/network_run.h"
#include "runs/run.h"
#include "runs/run_kind.h"
#include "scenario/load_scenario.h"

namespace stopline {
namespace {

Scenario hcm_scenario(const std::string& text) {
    return parse_scenario("{fidelity: meso, populations: [CTG-Ref], " + text + "}", "hcm.yaml");
}

Scenario hcm_intersection(const std::string& demand, const std::string& hcm) {
    return hcm_scenario(
        "network: {kind: intersection}, signal: {first_green: 1 s, green: 20 s}, measure: {warmup_cycles: 2, cycles: 30, "
        "hcm: " +
        hcm + "}, demand: " + demand);
}

// A light on one lane with evenly spaced arrivals. The road is long enough for vehicles to reach the speed limit.
Scenario hcm_light(const std::string& inflow) {
    return hcm_scenario(
        "meso: {base: table2, leader_speed_share: 100 %}, network: {approach: {length: 1000 m, exit_length: 700 m}}, "
        "signal: {first_green: 27 s, green: 30 s, yellow: 3 s, cycle: 60 s}, duration: 3600 s, measure: {green: [10 s], "
        "hcm: on}, demand: {kind: rate, inflow: " +
        inflow + "}");
}

TEST(HcmRun, CapacityOfASaturatedIntersectionMatchesCounts) {
    const Scenario scenario = hcm_intersection("{kind: saturated, start: queued, left: 0 %, right: 0 %}", "on");
    const IntersectionResult result = run_intersection(scenario, 0);
    int lanes = 0;
    for (const HcmRow& row : result.hcm) {
        if (row.scope != HcmRow::Scope::lane) continue;
        ++lanes;
        EXPECT_GE(row.cycles, 28);
        EXPECT_NEAR(row.capacity_veh_h, row.passed_veh_h, 0.03 * row.passed_veh_h) << row.name;
        EXPECT_EQ(row.state, HcmState::oversaturated) << row.name;
        EXPECT_EQ(row.level, 'F') << row.name;
        EXPECT_NEAR(row.green_s, 20.0, 1e-6);
    }
    EXPECT_EQ(lanes, 8);
    EXPECT_EQ(result.hcm.size(), 8U + 4U + 1U);
}

// The capacity measured below saturation predicts the count at saturation.
TEST(HcmRun, CapacityBelowSaturationPredictsTheSaturatedCount) {
    const auto lane = [](const std::string& inflow) { return run_population(hcm_light(inflow), 0).hcm.at(0); };
    const HcmRow below = lane("700 veh/h");
    const HcmRow above = lane("1600 veh/h");
    EXPECT_EQ(below.state, HcmState::free);
    EXPECT_LT(below.saturation, 0.95);
    EXPECT_EQ(above.state, HcmState::oversaturated);
    EXPECT_EQ(above.level, 'F');
    EXPECT_GT(above.saturation, 1.2);
    EXPECT_NEAR(below.capacity_veh_h, above.passed_veh_h, 0.03 * above.passed_veh_h);
}

// The formula counts the delay at the stop line. Measured delay includes the acceleration behind the line, which takes
// up to 4 s for the first vehicle of a queue.
TEST(HcmRun, DelayOfEvenArrivalsIsTheUniformDelayAndTheAcceleration) {
    for (const char* const inflow : {"500 veh/h", "700 veh/h"}) {
        const HcmRow row = run_population(hcm_light(inflow), 0).hcm.at(0);
        EXPECT_NEAR(row.volume_veh_h, std::stod(inflow), 0.02 * std::stod(inflow));
        EXPECT_GT(row.control_delay_s, row.uniform_delay_s) << inflow;
        EXPECT_LT(row.control_delay_s, row.uniform_delay_s + 2.5) << inflow;
        EXPECT_NEAR(row.initial_queue_delay_s, 0.0, 1e-9);
    }
}

// Without five vehicles in a queue there is no saturation flow, so there is no capacity.
TEST(HcmRun, ShortQueuesHaveNoCapacity) {
    const HcmRow row = run_population(hcm_light("300 veh/h"), 0).hcm.at(0);
    EXPECT_EQ(row.discharge.saturated_greens, 0);
    EXPECT_TRUE(std::isnan(row.capacity_veh_h));
    EXPECT_TRUE(std::isnan(row.formula_delay_s()));
    EXPECT_GT(row.control_delay_s, 0.0);
    EXPECT_EQ(row.formula_level, '-');
}

TEST(HcmRun, DoesNotChangeTheRun) {
    const std::string demand = "{kind: rate, inflow: 500 veh/h, arrivals: poisson, left: 10 %}";
    const IntersectionResult with = run_intersection(hcm_intersection(demand, "on"), 0);
    const IntersectionResult without = run_intersection(hcm_intersection(demand, "off"), 0);
    EXPECT_EQ(with.state_hash, without.state_hash);
    EXPECT_TRUE(without.hcm.empty());
    const auto columns = [&](const std::string& hcm) {
        std::vector<std::string> names;
        const Scenario scenario = hcm_intersection(demand, hcm);
        for (const RunMetric& metric : run_kind(scenario).metrics(scenario, 0, [] { return true; })) {
            names.push_back(metric.column);
        }
        return names;
    };
    const std::vector<std::string> on = columns("on");
    const std::vector<std::string> off = columns("off");
    EXPECT_EQ(on.size(), off.size() + 3);
    EXPECT_EQ(std::count(on.begin(), on.end(), "hcm_los"), 1);
    EXPECT_EQ(std::count(off.begin(), off.end(), "hcm_los"), 0);
}

// Left turns have a protected green and a permissive one, with a red between them. Their cycle is that of the signal.
TEST(HcmRun, LanesWithTwoGreensHaveTheCycleOfTheSignal) {
    const IntersectionResult result = run_intersection(
        load_scenario(STOPLINE_SOURCE_DIR "/scenarios/dual_ring.yaml", {"measure.hcm=on", "measure.cycles=20"}), 0);
    int lanes_with_two_greens = 0;
    for (const HcmRow& row : result.hcm) {
        if (row.scope != HcmRow::Scope::lane) continue;
        EXPECT_NEAR(row.cycle_s, 90.0, 1.0) << row.name;
        EXPECT_GE(row.cycles, 18) << row.name;
        EXPECT_LE(row.cycles, 20) << row.name;
        const bool is_left = row.name.ends_with("_0");
        EXPECT_EQ(row.greens_per_cycle > 1.0, is_left) << row.name;
        EXPECT_EQ(std::isnan(row.formula_delay_s()), is_left) << row.name;
        lanes_with_two_greens += is_left ? 1 : 0;
    }
    EXPECT_EQ(lanes_with_two_greens, 4);
}

// A fixed-time programme of 90 s with two separate greens of the left turns.
TEST(HcmRun, FixedTimeLanesWithTwoGreensHaveTheCycleOfTheSignal) {
    const std::string network =
        "network: {kind: intersection, intersection: {lanes: [{movements: left}, {movements: straight+right}]}}, ";
    const std::string signal =
        "signal: {first_green: 1 s, phases: [{protected: [west_left, east_left], green: 8 s, yellow: 3 s, all_red: 2 s}, "
        "{protected: [south_straight, south_right, north_straight, north_right], permissive: [south_left, north_left], "
        "green: 25 s, yellow: 3 s, all_red: 2 s}, "
        "{protected: [west_straight, west_right, east_straight, east_right], permissive: [west_left, east_left], "
        "green: 32 s, yellow: 3 s, all_red: 2 s}, {green: 8 s, yellow: 0 s, all_red: 2 s}]}, ";
    const IntersectionResult result =
        run_intersection(hcm_scenario(network + signal + "measure: {warmup_cycles: 1, cycles: 8, hcm: on}, " +
                                      "demand: {kind: saturated, start: queued}"),
                         0);
    for (const HcmRow& row : result.hcm) {
        if (row.scope != HcmRow::Scope::lane) continue;
        EXPECT_NEAR(row.cycle_s, 90.0, 1e-6) << row.name;
        const bool has_two_greens = row.name == "west_in_0" || row.name == "east_in_0";
        EXPECT_DOUBLE_EQ(row.greens_per_cycle, has_two_greens ? 2.0 : 1.0) << row.name;
        if (has_two_greens) {
            EXPECT_NEAR(row.green_s, 40.0, 1e-6) << row.name;
        }
    }
}

// The programme of Kantstraße gives green to the left turns of the major street twice in a cycle.
TEST(HcmRun, StreetLanesWithTwoGreensHaveTheCycleOfTheSignal) {
    const NetworkResult result =
        run_network(load_scenario(STOPLINE_SOURCE_DIR "/scenarios/berlin.yaml",
                                  {"measure.hcm=on", "duration=420 s", "measure.window=300 s"}),
                    0);
    int lanes_with_two_greens = 0;
    for (const HcmRow& row : result.hcm) {
        if (row.scope != HcmRow::Scope::lane) continue;
        EXPECT_NEAR(row.cycle_s, 60.0, 1e-6) << row.name;
        lanes_with_two_greens += row.greens_per_cycle > 1.0 ? 1 : 0;
    }
    EXPECT_GT(lanes_with_two_greens, 0);
}

// Few vehicles come from south and north, so the actuated controller skips their phase in about every second cycle.
// Nevertheless all lanes have the cycles of the controller.
TEST(HcmRun, LanesOfAnActuatedSignalHaveTheSameCycles) {
    const IntersectionResult result = run_intersection(
        hcm_scenario(
            "seed: 3, network: {kind: intersection, intersection: {lanes: [{movements: left}, {movements: "
            "straight+right}]}}, signal: {first_green: 1 s, controller: actuated, phases: ["
            "{protected: [west_straight, east_straight, west_right, east_right], green: 15 s, max_green: 30 s}, "
            "{protected: [west_left, east_left, west_right, east_right], green: 6 s, max_green: 12 s}, "
            "{protected: [south_straight, north_straight, south_right, north_right], permissive: [south_left, "
            "north_left], green: 10 s, max_green: 20 s}]}, measure: {warmup_cycles: 2, cycles: 40, hcm: on}, "
            "demand: {kind: saturated, cross_inflow: 20 veh/h}"),
        0);
    int most = 0;
    double cycle_s = 0.0;
    for (const HcmRow& row : result.hcm) {
        if (row.scope == HcmRow::Scope::lane && row.cycles > most) most = row.cycles, cycle_s = row.cycle_s;
    }
    EXPECT_GT(most, 30);
    int lanes_with_skipped_greens = 0;
    for (const HcmRow& row : result.hcm) {
        if (row.scope != HcmRow::Scope::lane) continue;
        EXPECT_GE(row.cycles, most - 2) << row.name;
        EXPECT_NEAR(row.cycle_s, cycle_s, 0.05 * cycle_s) << row.name;
        EXPECT_FALSE(row.has_several_greens) << row.name;
        lanes_with_skipped_greens += row.greens_per_cycle < 0.7 ? 1 : 0;
    }
    EXPECT_EQ(lanes_with_skipped_greens, 4);
}

// The programme of phases changes at 8:00 h, during the run. The first cycle of the other programme is a cycle of its
// own, so each lane has one green in each cycle.
TEST(HcmRun, AnotherProgrammeBeginsACycle) {
    const auto phases = [](const std::string& green) {
        const std::string times = ", green: " + green + ", max_green: " + green + "}";
        return "phases: [{protected: [west_straight, east_straight, west_right, east_right], permissive: [west_left, "
               "east_left]" +
               times +
               ", {protected: [south_straight, north_straight, south_right, north_right], permissive: [south_left, "
               "north_left]" +
               times + "]";
    };
    const IntersectionResult result = run_intersection(
        hcm_scenario("network: {kind: intersection}, signal: {first_green: 1 s, controller: actuated, clock: 7.95 h, "
                     "programmes: [{from: 0 h, " +
                     phases("15 s") + "}, {from: 8 h, " + phases("20 s") +
                     "}]}, measure: {warmup_cycles: 1, cycles: 10, hcm: on}, demand: {kind: saturated, start: queued}"),
        0);
    int lanes = 0;
    for (const HcmRow& row : result.hcm) {
        if (row.scope != HcmRow::Scope::lane) continue;
        ++lanes;
        EXPECT_DOUBLE_EQ(row.greens_per_cycle, 1.0) << row.name;
        EXPECT_FALSE(row.has_several_greens) << row.name;
        EXPECT_GE(row.cycles, 9) << row.name;
        EXPECT_LT(row.cycle_s, 56.1) << row.name;  // 46 s, then 56 s
    }
    EXPECT_EQ(lanes, 8);
}

TEST(HcmRun, CoversTheLanesOfNetworksAndActuatedSignals) {
    const Scenario scenario = hcm_scenario(
        "network: {kind: grid, grid: {columns: 2, rows: 1}}, signal: {first_green: 1 s, controller: actuated, phases: "
        "[{protected: [west_straight, east_straight], permissive: [west_left, east_left, west_right, east_right], green: 20 "
        "s}, {protected: [south_straight, north_straight], permissive: [south_left, north_left, south_right, "
        "north_right], green: 20 s}]}, duration: 900 s, measure: {window: 800 s, hcm: on}, demand: {kind: rate, inflow: 400 veh/h}");
    const NetworkResult result = run_network(scenario, 0);
    Scenario off = scenario;
    off.measure.hcm = "off";
    EXPECT_EQ(run_network(off, 0).state_hash, result.state_hash);
    int intersections = 0;
    for (const HcmRow& row : result.hcm) {
        intersections += row.scope == HcmRow::Scope::intersection ? 1 : 0;
        if (row.scope != HcmRow::Scope::lane) continue;
        EXPECT_GT(row.cycles, 3) << row.name;
        EXPECT_LT(row.green_s, row.cycle_s) << row.name;
        EXPECT_GE(row.control_delay_s, 0.0) << row.name;
        EXPECT_LT(row.control_delay_s, 100.0) << row.name;
        EXPECT_NE(row.level, '-') << row.name;
    }
    EXPECT_EQ(intersections, 2);
}

// In each cycle of 16 s, one or two vehicles pass, and one or two are teleported. Others take their places.
TEST(HcmRun, TeleportedVehiclesCountAsArrivals) {
    const NetworkResult result = run_network(
        hcm_scenario(
            "network: {kind: grid, intersection: {lanes: [{movements: straight}]}, grid: {columns: 2, rows: 1}}, "
            "signal: {first_green: 1 s, green: 2 s, yellow: 3 s, all_red: 3 s}, demand: {kind: saturated}, "
            "rules: {teleport_cycles: 0.1}, duration: 300 s, measure: {window: 200 s, hcm: on}"),
        0);
    int lanes = 0;
    for (const HcmRow& row : result.hcm) {
        if (row.scope != HcmRow::Scope::lane) continue;
        ++lanes;
        EXPECT_GT(row.volume_veh_h, 1.5 * row.passed_veh_h) << row.name;
    }
    EXPECT_EQ(lanes, 8);
}

}  // namespace
}  // namespace stopline
