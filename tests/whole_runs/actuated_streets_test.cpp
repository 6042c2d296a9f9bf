// Runs of streets whose signals are actuated.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "base/containers/index.h"
#include "runs/network/network_run.h"
#include "scenario/build_model.h"
#include "scenario/load_scenario.h"
#include "sim/step/simulation.h"

namespace stopline {
namespace {

constexpr int kGroups = 3;  // signal groups of an intersection: major, left, minor

Scenario berlin(std::vector<std::string> settings) {
    settings.insert(settings.begin(), {"populations=[CDG]", "measure.baseline=CDG", "duration=400 s",
                                       "measure.window=200 s", "signal.controller=actuated"});
    return load_scenario(STOPLINE_SOURCE_DIR "/scenarios/berlin.yaml", settings);
}

// A light that a group has shown from its begin to its end.
struct ShownLight {
    int group = 0;
    Light light = Light::red;
    int phase = -1;  // phase of its signal at the end
    double start_s = 0.0;
    double length_s = 0.0;
    // For this time at its end, a vehicle has stood before a red light of the intersection.
    double called_s = 0.0;
};

// Steps a simulation and records each light that has ended. Fails if two lights contradict each other.
class LightRecord {
public:
    explicit LightRecord(const Scenario& scenario) : model_(build_model(scenario, 0)), simulation_(model_) {}

    void run(double end_s) {
        std::vector<double> uncalled_s(model_.signals.size());  // latest time without a vehicle before a red light
        while (simulation_.time_s() < end_s) {
            for (std::size_t signal = 0; signal < uncalled_s.size(); ++signal) {
                if (!has_call(signal)) uncalled_s[signal] = simulation_.time_s();
            }
            const std::vector<Light> before = signals().lights;
            const std::vector<std::int64_t> since = signals().since_tick;
            const std::vector<int> phases = signals().phase;
            simulation_.step();
            for (std::size_t group = 0; group < before.size(); ++group) {
                if (signals().lights[group] == before[group]) continue;
                const double start_s = model_.time_s(since[group]);
                shown.push_back({static_cast<int>(group), before[group], phases[group / kGroups], start_s,
                                 model_.time_s(signals().since_tick[group]) - start_s,
                                 model_.time_s(signals().since_tick[group]) - uncalled_s[group / kGroups]});
            }
            for (std::size_t signal = 0; signal < phases.size(); ++signal) check_lights(signal);
        }
    }

    std::vector<ShownLight> of(Light light) const {
        std::vector<ShownLight> found;
        std::copy_if(shown.begin(), shown.end(), std::back_inserter(found),
                     [&](const ShownLight& one) { return one.light == light; });
        return found;
    }
    // Returns how often a phase of an intersection has ended its green.
    int greens_of(int signal, int phase) const {
        const std::vector<ShownLight> greens = of(Light::green);
        return static_cast<int>(std::count_if(greens.begin(), greens.end(), [&](const ShownLight& one) {
            return one.group / kGroups == signal && one.phase == phase;
        }));
    }

    const SignalPlan& plan(int signal) const { return model_.signals[at(signal)]; }
    const Model& model() const { return model_; }
    const State& state() const { return simulation_.state(); }
    const SignalState& signals() const { return simulation_.state().signals; }
    std::vector<ShownLight> shown;

private:
    bool has_call(std::size_t signal) const {
        const std::vector<SignalDetector>& detectors = signals().detectors[signal];
        return std::any_of(detectors.begin(), detectors.end(), [&](const SignalDetector& detector) {
            const std::size_t group = signal * kGroups + at(detector.group);
            const bool is_at_line = detector.to_line_m > 0.0 && detector.to_line_m < 4.0;  // signal.stop_detector
            return is_at_line && detector.is_occupied && signals().lights[group] == Light::red;
        });
    }

    void check_lights(std::size_t signal) const {
        const auto light = [&](int group) { return signals().lights[signal * kGroups + at(group)]; };
        const bool minor = light(2) != Light::red;
        ASSERT_FALSE(minor && light(0) != Light::red) << signal << " at " << simulation_.time_s() << " s";
        ASSERT_FALSE(minor && light(1) != Light::red) << signal << " at " << simulation_.time_s() << " s";
        // A protected left turn has green alone.
        const bool has_left = model_.signals[signal].phases.phases.size() == 3;
        const bool is_protected = has_left && signals().phase[signal] == 1;
        ASSERT_FALSE(is_protected && light(0) != Light::red) << simulation_.time_s() << " s";
    }

    Model model_;
    Simulation simulation_;
};

// Checks the lengths of greens, yellows and reds. The maximum of a green counts from the first call of another phase.
// Returns the number of greens that had a call for longer than half of their maximum.
int check_lengths(const LightRecord& record) {
    constexpr double kTolerance_s = 1e-6;
    constexpr double kTicks_s = 0.2;  // the test sees detectors after the step, the controller before
    int long_calls = 0;
    for (const ShownLight& one : record.of(Light::green)) {
        const SignalPlan& plan = record.plan(one.group / kGroups);
        const SignalPhase& phase = plan.phases.phases[at(one.phase)];
        const double min_s = record.model().time_s(phase.min_green_ticks);
        const double max_s = record.model().time_s(std::max(phase.max_green_ticks, phase.min_green_ticks));
        EXPECT_GE(one.length_s, min_s - kTolerance_s) << one.group << " at " << one.start_s;
        const double called_s = std::min(one.called_s, one.length_s);
        EXPECT_LE(called_s, max_s + kTicks_s) << one.group << " at " << one.start_s;
        long_calls += called_s > 0.5 * max_s ? 1 : 0;
    }
    for (const ShownLight& one : record.of(Light::yellow)) EXPECT_NEAR(one.length_s, 3.0, kTolerance_s) << one.group;
    // Between the yellow of a group and the next green of the intersection lies the clearance, 8 s or more.
    for (const ShownLight& yellow : record.of(Light::yellow)) {
        const double end_s = yellow.start_s + yellow.length_s;
        for (const ShownLight& green : record.of(Light::green)) {
            if (green.group / kGroups != yellow.group / kGroups || green.start_s < end_s) continue;
            EXPECT_GE(green.start_s, end_s + 8.0 - kTolerance_s) << yellow.group << " at " << end_s;
        }
    }
    return long_calls;
}

TEST(ActuatedStreets, KeepMinimumMaximumYellowAndClearance) {
    LightRecord record(berlin({}));
    record.run(400.0);
    EXPECT_GT(check_lengths(record), 30);
    EXPECT_TRUE(record.state().records.violations.none());
    EXPECT_GT(record.state().records.exited, 300);
    for (int signal = 0; signal < 10; ++signal) {
        for (std::size_t phase = 0; phase < record.plan(signal).phases.phases.size(); ++phase) {
            EXPECT_GT(record.greens_of(signal, static_cast<int>(phase)), 0) << signal << ", phase " << phase;
        }
    }
}

TEST(ActuatedStreets, KeepMinimumMaximumYellowAndClearanceInFullDynamics) {
    LightRecord record(berlin({"fidelity=full", "duration=150 s", "measure.window=60 s"}));
    record.run(150.0);
    EXPECT_GT(check_lengths(record), 10);
    EXPECT_TRUE(record.state().records.violations.none());
    EXPECT_GT(record.of(Light::green).size(), 30u);
}

// The first intersection protects the left turns of the major street. Its other greens do not depend on them.
TEST(ActuatedStreets, SkipTheProtectedLeftWithoutACall) {
    LightRecord with_left(berlin({}));
    with_left.run(300.0);
    EXPECT_GT(with_left.greens_of(0, 1), 2);

    const std::string legs = "network.streets.intersections[koenigin_elisabeth_str].legs";
    LightRecord without_left(berlin({legs + "[0].left=0 %", legs + "[1].left=0 %"}));
    without_left.run(300.0);
    EXPECT_EQ(without_left.greens_of(0, 1), 0);
    EXPECT_GT(without_left.greens_of(0, 2), 3);
    EXPECT_TRUE(without_left.state().records.violations.none());
}

// During the protected phase, no left-turning vehicle of the first intersection waits for a vehicle with priority.
TEST(ActuatedStreets, ProtectedLeftTurnsDoNotYield) {
    const Model model = build_model(berlin({}), 0);
    Simulation simulation(model);
    int protected_waits = 0;
    int permissive_waits = 0;
    while (simulation.time_s() < 400.0) {
        simulation.step();
        const State& state = simulation.state();
        if (state.signals.lights[1] != Light::green) continue;
        for (std::size_t lane = 0; lane < model.graph.lanes.size(); ++lane) {
            if (model.graph.lanes[lane].signal_group != 1) continue;
            const YieldStops& stops = yield_stops_of(state, static_cast<int>(lane));
            for (int k = 0; k < stops.count; ++k) {
                if (stops.stops[at(k)].reason != YieldReason::priority) continue;
                ++(state.signals.phase[0] == 1 ? protected_waits : permissive_waits);
            }
        }
    }
    EXPECT_EQ(protected_waits, 0);
    EXPECT_GT(permissive_waits, 100);
}

TEST(ActuatedStreets, HaveTheSameHashWithSeveralThreads) {
    const Scenario scenario = berlin({"duration=240 s", "measure.window=120 s"});
    const NetworkResult one = run_network(scenario, 0);
    EXPECT_TRUE(one.violations.none());
    EXPECT_EQ(one.state_hash, run_network(scenario, 0, {}, 2).state_hash);
}

}  // namespace
}  // namespace stopline
