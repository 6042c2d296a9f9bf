// Runs of intersections and grids whose signals have phases: protected and permissive left turns, pedestrians,
// programmes by time of day.
#include <gtest/gtest.h>

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

const std::string kWestEast = "west_straight, west_right, east_straight, east_right";
const std::string kSouthNorth = "south_straight, south_right, north_straight, north_right";

// Returns the reference intersection with a lane for left turns and with these phases.
Scenario with_phases(const std::string& phases, std::vector<std::string> settings = {}) {
    settings.insert(settings.begin(),
                    {"populations=[CTG-Ref]", "fidelity=meso", "demand.right=30 %", "measure.zones=[]",
                     "network.intersection.lanes=[{movements: left}, {movements: straight+right}]",
                     "signal={first_green: 1 s, phases: [" + phases + "]}"});
    return load_scenario(STOPLINE_SOURCE_DIR "/scenarios/intersection.yaml", settings);
}

std::string protected_lefts() {
    return "{protected: [west_left, east_left], green: 12 s}, {protected: [" + kWestEast +
           "], green: 20 s}, {protected: [south_left, north_left], green: 12 s}, {protected: [" + kSouthNorth +
           "], green: 20 s}";
}

std::string permissive_lefts() {
    return "{protected: [" + kWestEast + "], permissive: [west_left, east_left], green: 32 s}, {protected: [" +
           kSouthNorth + "], permissive: [south_left, north_left], green: 32 s}";
}

struct LeftTurns {
    int waits_for_priority = 0;  // steps in which a left-turning vehicle waits for a vehicle with priority
    int passed = 0;              // left-turning vehicles
    bool has_violations = false;
};

LeftTurns left_turns_of(const Scenario& scenario, double end_s) {
    const Model model = build_model(scenario, 0);
    Simulation simulation(model);
    LeftTurns result;
    while (simulation.time_s() < end_s) {
        simulation.step();
        for (std::size_t lane = 0; lane < model.graph.lanes.size(); ++lane) {
            const YieldStops& stops = yield_stops_of(simulation.state(), static_cast<int>(lane));
            const Lane& road = model.graph.lanes[lane];
            const bool leads_left = road.turn == Turn::left ||
                                    (road.next.size() == 1 && model.graph.lanes[at(road.next[0])].turn == Turn::left);
            for (int k = 0; leads_left && k < stops.count; ++k) {
                result.waits_for_priority += stops.stops[at(k)].reason == YieldReason::priority ? 1 : 0;
            }
        }
    }
    for (const Passage& passage : simulation.state().records.passages) {
        if (passage.from_lane >= 0 && model.graph.lanes[at(passage.from_lane)].turn == Turn::left) ++result.passed;
    }
    result.has_violations = !simulation.state().records.violations.none();
    return result;
}

// The cycles are 96 s with protected left turns and 80 s with permissive ones.
TEST(SignalPhases, ProtectedLeftTurnsPassWithoutYieldingAndPermissiveOnesYield) {
    const LeftTurns with_protection = left_turns_of(with_phases(protected_lefts()), 600.0);
    EXPECT_EQ(with_protection.waits_for_priority, 0);
    EXPECT_FALSE(with_protection.has_violations);
    // In each of six cycles, four left-turn lanes discharge for 12 s.
    EXPECT_GT(with_protection.passed, 6 * 4 * 4);

    const LeftTurns without_protection = left_turns_of(with_phases(permissive_lefts()), 600.0);
    EXPECT_GT(without_protection.waits_for_priority, 1000);
    EXPECT_FALSE(without_protection.has_violations);
    EXPECT_LT(without_protection.passed, with_protection.passed);
}

// A phase with protected left turns follows a phase in which they are permissive. They keep their green between them.
TEST(SignalPhases, PermissiveLeftTurnsCanBecomeProtected) {
    const std::string phases = "{protected: [" + kWestEast +
                               "], permissive: [west_left, east_left], green: 20 s, yellow: 3 s, all_red: 2 s}, " +
                               "{protected: [west_left, east_left], green: 10 s}, {protected: [" + kSouthNorth +
                               "], permissive: [south_left, north_left], green: 20 s}";
    const Scenario scenario = with_phases(phases);
    const Model model = build_model(scenario, 0);
    Simulation simulation(model);
    const auto group_of = [&](const std::string& name) {
        for (const Lane& lane : model.graph.lanes) {
            if (lane.name == name) return lane.signal_group;
        }
        return -1;
    };
    const std::size_t left = at(group_of("west_in_0"));
    int protected_waits = 0;
    int green_changes = 0;
    std::vector<int> phase_ticks(3);
    while (simulation.time_s() < 601.0) {
        const Light before = simulation.state().signals.lights[left];
        simulation.step();
        const State& state = simulation.state();
        if (before != Light::green && state.signals.lights[left] == Light::green) ++green_changes;
        if (state.signals.phase[0] >= 0) ++phase_ticks[at(state.signals.phase[0])];
        if (state.signals.phase[0] != 1 || state.tick - state.signals.phase_start_tick[0] < 50) continue;
        for (std::size_t lane = 0; lane < model.graph.lanes.size(); ++lane) {
            if (model.graph.lanes[lane].turn != Turn::left) continue;
            for (int k = 0; k < yield_stops_of(state, static_cast<int>(lane)).count; ++k)
                protected_waits +=
                    yield_stops_of(state, static_cast<int>(lane)).stops[at(k)].reason == YieldReason::priority ? 1 : 0;
        }
    }
    EXPECT_EQ(protected_waits, 0);
    // The cycle is 25 s + 18 s + 28 s.
    EXPECT_EQ(green_changes, 9);
    EXPECT_NEAR(phase_ticks[0], 10 * (8 * 25 + 25), 1);
    EXPECT_NEAR(phase_ticks[1], 10 * (8 * 18), 160);
    EXPECT_TRUE(simulation.state().records.violations.none());
}

// Two phases that do what the two groups of a signal without phases do give the same run, bit by bit.
TEST(SignalPhases, TwoStreetsAsPhasesGiveTheSameRunAsWithoutPhases) {
    const std::string phases =
        "[{protected: [west_straight, east_straight], permissive: [west_left, east_left, west_right, east_right], green: "
        "15 s}, {protected: [south_straight, north_straight], permissive: [south_left, north_left, south_right, "
        "north_right], green: 15 s}]";
    const std::vector<std::string> common{"populations=[CDG]", "measure.baseline=CDG", "demand.left=15 %",
                                          "demand.right=10 %"};
    for (const char* const fidelity : {"fidelity=meso", "fidelity=full"}) {
        std::vector<std::string> settings = common;
        settings.emplace_back(fidelity);
        const std::string file = STOPLINE_SOURCE_DIR "/scenarios/intersection.yaml";
        const IntersectionResult without = run_intersection(load_scenario(file, settings), 0);
        settings.push_back("signal={first_green: 1 s, phases: " + phases + "}");
        const IntersectionResult with = run_intersection(load_scenario(file, settings), 0);
        EXPECT_EQ(with.state_hash, without.state_hash) << fidelity;
        EXPECT_EQ(with.throughput_veh_h, without.throughput_veh_h);
        EXPECT_EQ(with.queue_veh, without.queue_veh);
        EXPECT_EQ(with.discharge.greens, without.discharge.greens);
        EXPECT_TRUE(with.violations.none());
    }
}

TEST(SignalPhases, APedestrianPhaseTakesItsTime) {
    const std::string phases = permissive_lefts() + ", {green: 14 s, yellow: 0 s, all_red: 1 s}";
    const Scenario scenario = with_phases(phases);
    EXPECT_EQ(scenario.nominal_cycle().cycle_s, 40.0 + 40.0 + 15.0);
    EXPECT_EQ(scenario.nominal_cycle().longest_green_s, 32.0);
    const Model model = build_model(scenario, 0);
    Simulation simulation(model);
    int all_red_ticks = 0;
    while (simulation.time_s() < 1.0 + 2 * 95.0) {
        const std::vector<Light>& lights = simulation.state().signals.lights;
        const bool is_red = std::all_of(lights.begin(), lights.end(), [](Light light) { return light == Light::red; });
        all_red_ticks += is_red ? 1 : 0;
        simulation.step();
    }
    // 1 s at the start, and in each cycle twice 5 s and the 15 s of the pedestrians.
    EXPECT_EQ(all_red_ticks, 10 * (1 + 2 * (5 + 5 + 15)));
}

Scenario grid_with(const std::string& signal) {
    return load_scenario(STOPLINE_SOURCE_DIR "/scenarios/grid.yaml",
                         {"populations=[CDG]", "measure.baseline=CDG", "duration=400 s", "measure.window=200 s",
                          "network.grid={columns: 2, rows: 2}", "demand.left=15 %", "signal=" + signal});
}

// Lanes that go straight on or turn left have two signal groups. One street has a leading left turn on one side.
std::string shared_lanes() {
    return "[{protected: [west_left, west_straight, west_right], green: 8 s, yellow: 3 s, all_red: 1 s}, {protected: "
           "[west_straight, east_straight], permissive: [west_left, east_left, west_right, east_right], green: 15 s}, "
           "{protected: [south_straight, north_straight], permissive: [south_left, north_left, south_right, north_right], "
           "green: 15 s}]";
}

TEST(SignalPhases, AGridHasTheSameHashWithSeveralThreads) {
    const Scenario grid = grid_with("{first_green: 1 s, offset: 12 s, phases: " + shared_lanes() + "}");
    const NetworkResult one = run_network(grid, 0);
    EXPECT_TRUE(one.violations.none());
    EXPECT_GT(one.measured.throughput_veh_h(), 1000.0);
    EXPECT_EQ(one.state_hash, run_network(grid, 0, {}, 2).state_hash);
    // The order of phases matters.
    const Scenario other = grid_with("{first_green: 1 s, offset: 13 s, phases: " + shared_lanes() + "}");
    EXPECT_NE(one.state_hash, run_network(other, 0).state_hash);
}

TEST(SignalPhases, ProgrammesChangeDuringARun) {
    const std::string short_greens =
        "[{protected: [west_straight, east_straight], permissive: [west_left, east_left, west_right, east_right], green: 5 "
        "s}, {protected: [south_straight, north_straight], permissive: [south_left, north_left, south_right, north_right], "
        "green: 5 s}]";
    const Scenario grid =
        grid_with("{first_green: 0 s, clock: 7 h, programmes: [{from: 6 h, phases: " + shared_lanes() +
                  "}, {from: 7.05 h, phases: " + short_greens + "}]}");
    const Model model = build_model(grid, 0);
    Simulation simulation(model);
    // The first programme has a cycle of 58 s. It ends at 232 s, after 7.05 h (180 s).
    while (simulation.time_s() < 231.9) simulation.step();
    EXPECT_EQ(simulation.state().signals.phase[0], 2);
    while (simulation.time_s() < 232.05) simulation.step();
    EXPECT_EQ(simulation.state().signals.phase[0], 3);
    while (simulation.time_s() < 400.0) simulation.step();
    EXPECT_TRUE(simulation.state().records.violations.none());
}

// The left-turn lanes get no traffic, so their phases are skipped. The other greens last between minimum and maximum.
TEST(ActuatedSignals, SkipPhasesWithoutTrafficAndEndGreensAtGaps) {
    const auto phase = [](const std::string& movements) {
        return "{protected: [" + movements + "], green: 40 s, min_green: 5 s}";
    };
    const std::string phases = phase("west_left, east_left") + ", " + phase(kWestEast) + ", " +
                               phase("south_left, north_left") + ", " + phase(kSouthNorth);
    Scenario scenario = with_phases(phases, {"signal.controller=actuated", "demand={kind: rate, inflow: 600 veh/h}"});
    Model model = build_model(scenario, 0);
    std::erase_if(model.demand.inlets, [&](const DemandPlan::Inlet& inlet) {
        return model.graph.lanes[at(inlet.lane)].name.ends_with("_in_0");
    });
    Simulation simulation(model);
    std::vector<int> begins(4);
    std::vector<std::int64_t> greens;
    while (simulation.time_s() < 900.0) {
        const int before = simulation.state().signals.phase[0];
        const std::vector<Light> lights = simulation.state().signals.lights;
        simulation.step();
        const SignalState& signals = simulation.state().signals;
        if (signals.phase[0] != before && signals.phase[0] >= 0) ++begins[at(signals.phase[0])];
        for (std::size_t group = 0; group < lights.size(); ++group) {
            if (lights[group] == Light::green && signals.lights[group] != Light::green)
                greens.push_back(signals.since_tick[group] - signals.green_start_tick[group]);
        }
    }
    EXPECT_LE(begins[0], 1) << "only the first phase of the run may begin without a call";
    EXPECT_EQ(begins[2], 0);
    EXPECT_GT(begins[1], 10);
    EXPECT_GT(begins[3], 10);
    int below_maximum = 0;
    for (const std::int64_t ticks : greens) {
        EXPECT_GE(ticks, 50);
        EXPECT_LE(ticks, 400);
        below_maximum += ticks < 400 ? 1 : 0;
    }
    EXPECT_GT(below_maximum, 20);
    EXPECT_TRUE(simulation.state().records.violations.none());
    EXPECT_GT(simulation.state().records.exited, 200);
}

TEST(ActuatedSignals, AGridHasTheSameHashWithSeveralThreads) {
    const Scenario grid = grid_with("{first_green: 1 s, controller: actuated, phases: " + shared_lanes() + "}");
    const NetworkResult one = run_network(grid, 0);
    EXPECT_TRUE(one.violations.none());
    EXPECT_GT(one.measured.throughput_veh_h(), 1000.0);
    EXPECT_EQ(one.state_hash, run_network(grid, 0, {}, 2).state_hash);
    const Scenario fixed = grid_with("{first_green: 1 s, phases: " + shared_lanes() + "}");
    EXPECT_NE(one.state_hash, run_network(fixed, 0).state_hash);
}

}  // namespace
}  // namespace stopline
