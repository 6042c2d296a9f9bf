// This file registers a signal controller that reacts to traffic. Scenarios can name it, and all kinds of runs obey it.
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "base/input_error.h"
#include "runs/intersection/intersection_run.h"
#include "runs/network/network_run.h"
#include "runs/single_light/single_light.h"
#include "scenario/build_model.h"
#include "scenario/load_scenario.h"
#include "signals/signal_controller.h"
#include "sim/step/simulation.h"

namespace stopline {
namespace {

constexpr std::size_t kFreeTime = 0;  // index in SignalPlan::values
constexpr std::array kParameters{SignalParameter{"free_time", "s", 1, 60, "3 s", "test: green ends after this time"}};

// Indices in the memory of the controller (SignalView::memory()), and their number. kGroup: the group that has green.
enum : std::size_t { kGroup, kNumbers };

std::size_t memory_size(const SignalPlan& /*plan*/) { return kNumbers; }

NominalCycle nominal(const SignalSettings& settings, int groups) {
    return {groups * settings.stage_s(0), settings.green_s};
}

std::int64_t init(SignalView& view) {
    view.memory()[kGroup] = -1;
    return to_ticks(view.plan().settings.first_green_s, view.plan().step_s);
}

// Returns true if no detector of the group has been occupied for the time `free_time`.
bool is_free(const SignalView& view, int group) {
    const std::int64_t free_ticks = to_ticks(view.plan().values[kFreeTime], view.plan().step_s);
    for (const SignalDetector& detector : view.detectors()) {
        if (detector.group == group && detector.last_occupied_tick > view.tick() - free_ticks) return false;
    }
    return true;
}

// Each group has green until its detectors have been free for some time, but at least for the green time of the
// settings. Yellow and all red follow. Then the next group has green.
std::int64_t step(SignalView& view) {
    std::int64_t& group = view.memory()[kGroup];
    const SignalSettings& times = view.plan().settings;
    const double step_s = view.plan().step_s;
    if (group >= 0 && view.light(static_cast<int>(group)) == Light::green) {
        const std::int64_t end = view.since_tick(static_cast<int>(group)) + to_ticks(times.green_s, step_s);
        if (view.tick() < end || !is_free(view, static_cast<int>(group))) return view.tick() + 1;
        view.show(static_cast<int>(group), Light::yellow);
        return view.tick() + to_ticks(times.yellow_s, step_s);
    }
    if (group >= 0 && view.light(static_cast<int>(group)) == Light::yellow) {
        view.show(static_cast<int>(group), Light::red);
        return view.tick() + to_ticks(times.all_red_s, step_s);
    }
    group = (group + 1) % view.groups();
    view.show(static_cast<int>(group), Light::green);
    return view.tick() + 1;
}

std::vector<double> detectors_m(const SignalSettings& /*settings*/) { return {30.0}; }

std::vector<SignalProblem> problems(const SignalSettings& settings, int /*groups*/) {
    if (settings.all_red_s >= 1.0) return {};
    return {{"all_red", "until_free needs at least 1 s"}};
}

constexpr SignalController kUntilFree{.name = "until_free",
                                      .meaning = "test: green until the detectors are free",
                                      .parameters = kParameters,
                                      .nominal_cycle = nominal,
                                      .init = init,
                                      .step = step,
                                      .memory_size = memory_size,
                                      .detectors_m = detectors_m,
                                      .problems = problems};

const bool kIsRegistered = (register_signal_controller(kUntilFree), true);

Scenario scenario_of(const std::string& file, std::vector<std::string> settings) {
    settings.emplace_back("signal.controller=until_free");
    settings.emplace_back("fidelity=meso");
    settings.emplace_back("populations=[CTG-Ref]");
    return load_scenario(STOPLINE_SOURCE_DIR "/scenarios/" + file, settings);
}

std::string error_of(const std::string& file, const std::vector<std::string>& settings) {
    try {
        load_scenario(STOPLINE_SOURCE_DIR "/scenarios/" + file, settings);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(SignalController, IsNamedInScenarios) {
    const Scenario scenario = scenario_of("single_light.yaml", {"signal.free_time=4 s"});
    EXPECT_EQ(scenario.signal.controller, "until_free");
    EXPECT_EQ(build_model(scenario, 0).signals[0].values, std::vector{4.0});
    EXPECT_EQ(build_model(scenario_of("single_light.yaml", {}), 0).signals[0].values, std::vector{3.0});
}

TEST(SignalController, WrongSettingsAreRefused) {
    const auto expect_error = [](const std::string& file, const std::vector<std::string>& settings,
                                 const std::string& part) {
        const std::string error = error_of(file, settings);
        EXPECT_NE(error.find(part), std::string::npos) << error;
    };
    expect_error("single_light.yaml", {"signal.controller=until_fre"}, "until_free");
    expect_error("single_light.yaml", {"signal.free_time=4 s"}, "applies only if controller is until_free");
    expect_error("single_light.yaml", {"signal.controller=until_free", "signal.free_time=0 s"}, "1 s to 60 s");
    expect_error("single_light.yaml", {"signal.controller=until_free", "signal.all_red=0 s"},
                 "field 'signal.all_red': until_free needs at least 1 s");
    expect_error("berlin.yaml", {"signal={controller: until_free}"}, "cannot run the programmes of streets");
}

// The first green ends when no detector of the approach has been occupied for 3 s.
TEST(SignalController, ReadsDetectors) {
    const Scenario scenario = scenario_of("single_light.yaml", {"demand.vehicles=10", "signal.first_green=60 s",
                                                                "signal.green=5 s", "measure.green=[5 s]"});
    const Model model = build_model(scenario, 0);
    Simulation simulation(model);
    const State& state = simulation.state();
    std::vector<std::int64_t> green_ends;
    std::size_t passed = 0;
    while (simulation.time_s() < 150.0) {
        const Light before = state.signals.lights[0];
        simulation.step();
        if (before == Light::green && state.signals.lights[0] == Light::yellow) green_ends.push_back(state.tick);
        if (green_ends.empty()) passed = state.records.crossings.size();
    }
    ASSERT_EQ(state.signals.detectors[0].size(), 2U);  // at the stop line and 30 m upstream
    EXPECT_NEAR(state.signals.detectors[0][0].to_line_m + state.signals.detectors[0][1].to_line_m, 30.0, 1e-9);
    ASSERT_GE(green_ends.size(), 2U);
    const std::int64_t last_occupied =
        std::max(state.signals.detectors[0][0].last_occupied_tick, state.signals.detectors[0][1].last_occupied_tick);
    EXPECT_EQ(green_ends[0] - last_occupied, to_ticks(3.0, model.step_s));
    EXPECT_GE(passed, 20U) << "the first green must last for the whole queue";
    EXPECT_TRUE(state.records.violations.none());
}

// In each kind of network with the section `signal`, vehicles obey the lights of the controller: there are no
// violations, and vehicles leave the network.
TEST(SignalController, ControlsEveryKindOfNetworkWithASignal) {
    const SingleLightReport single =
        run_single_light(scenario_of("single_light.yaml", {"signal.first_green=60 s"}), {});
    EXPECT_TRUE(single.no_violations());
    EXPECT_EQ(single.runs[0].green_start_s, 60.0);

    const Scenario crossing = scenario_of("intersection.yaml", {"demand={kind: rate, inflow: 500 veh/h}"});
    const IntersectionResult intersection = run_intersection(crossing, 0);
    EXPECT_TRUE(intersection.violations.none());
    EXPECT_EQ(intersection.violations.forced_red_entries, 0);
    EXPECT_GT(intersection.throughput_veh_h, 500.0);
    EXPECT_GT(intersection.discharge.greens, 0);

    const Scenario grid = scenario_of("grid.yaml", {"duration=200 s", "network.grid={columns: 2, rows: 2}"});
    const NetworkResult one = run_network(grid, 0);
    EXPECT_TRUE(one.violations.none());
    EXPECT_GT(one.measured.throughput_veh_h(), 100.0);
    EXPECT_EQ(one.state_hash, run_network(grid, 0, {}, 2).state_hash);
}

// Two states that differ only in the memory of a controller have different hashes.
TEST(SignalController, MemoryIsPartOfTheStateHash) {
    const Model model = build_model(scenario_of("single_light.yaml", {"signal.first_green=60 s"}), 0);
    const Simulation simulation(model);
    const std::uint64_t hash = simulation.state_hash();
    const_cast<State&>(simulation.state()).signals.memory[0][kGroup] = 5;
    EXPECT_NE(hash, simulation.state_hash());
}

}  // namespace
}  // namespace stopline
