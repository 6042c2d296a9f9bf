// Speed advice of signals (GLOSA): vehicles arrive at green without a stop, within their limits. What signals announce
// comes true.
#include "sim/speed_advice/speed_advice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "base/containers/index.h"
#include "base/speed_thresholds.h"
#include "scenario/build_model.h"
#include "scenario/load_scenario.h"
#include "signals/signal_controller.h"
#include "sim/step/simulation.h"

namespace stopline {
namespace {

// Vehicles that come from the west only and enter an empty road at the speed limit.
Scenario arriving_vehicles(const std::string& fidelity, int vehicles, std::vector<std::string> settings) {
    settings.insert(settings.begin(),
                    {"fidelity=" + fidelity, "populations=[CDG]", "measure.baseline=CDG", "measure.zones=[]",
                     "demand={kind: queue, vehicles: " + std::to_string(vehicles) +
                         ", approaches: [west], start: empty, entry_speed: 50 km/h}",
                     "network.intersection.lanes=[{movements: straight}]", "network.intersection.approach_length=400 m",
                     "signal.green=20 s"});
    return load_scenario(STOPLINE_SOURCE_DIR "/scenarios/intersection.yaml", settings);
}

struct Approach {
    double lowest_mps = 1e9;     // of all vehicles before their stop line, once they have been within 300 m of it
    double first_passage_s = 0;  // passage of the first vehicle at the stop line
    double green_s = 0;          // start of this green
    int passed = 0;              // vehicles that pass in this green
    bool has_violations = false;
};

Approach run(const Scenario& scenario) {
    const Model model = build_model(scenario, 0);
    Simulation simulation(model);
    Approach result;
    const auto lane = static_cast<int>(std::find_if(model.graph.lanes.begin(), model.graph.lanes.end(),
                                                    [](const Lane& one) { return one.name == "west_in_0"; }) -
                                       model.graph.lanes.begin());
    const Lane& road = model.graph.lanes[at(lane)];
    const auto group = at(road.signal_group);
    std::vector<int> waiting;
    while (simulation.time_s() < 120.0) {
        simulation.step();
        const State& state = simulation.state();
        const LaneBlock& block = state.blocks[at(lane)];
        std::vector<int> now;
        for (int slot = block.first; slot < block.past_last(); ++slot) {
            const double position_m = state.vehicles.position_m[at(slot)];
            if (position_m > road.stop_line_m) continue;
            now.push_back(state.vehicles.id[at(slot)]);
            if (position_m < road.stop_line_m - 300.0) continue;
            result.lowest_mps = std::min(result.lowest_mps, state.vehicles.speed_mps[at(slot)]);
        }
        const auto passed = static_cast<int>(std::count_if(waiting.begin(), waiting.end(), [&](int id) {
            return std::find(now.begin(), now.end(), id) == now.end();
        }));
        if (passed > 0 && result.passed == 0) {
            result.first_passage_s = simulation.time_s();
            result.green_s = model.time_s(state.signals.green_start_tick[group]);
        }
        if (model.time_s(state.signals.green_start_tick[group]) == result.green_s) result.passed += passed;
        waiting = now;
    }
    result.has_violations = !simulation.state().records.violations.none();
    return result;
}

TEST(SpeedForArrival, BrakesAndThenDrivesSoThatItArrivesInTime) {
    int braking = 0;
    for (const double speed_mps : {5.0, 10.0, 14.0}) {
        for (const double distance_m : {50.0, 150.0, 300.0}) {
            for (const double time_s : {10.0, 20.0, 40.0}) {
                constexpr double kBraking_mps2 = 1.0;
                const double target_mps = speed_for_arrival_mps(speed_mps, distance_m, time_s, kBraking_mps2);
                if (speed_mps * time_s <= distance_m) {
                    EXPECT_DOUBLE_EQ(target_mps, distance_m / time_s);
                    continue;
                }
                if (target_mps == 0.0) continue;
                ++braking;
                const double braking_s = (speed_mps - target_mps) / kBraking_mps2;
                const double braking_m = 0.5 * (speed_mps + target_mps) * braking_s;
                EXPECT_NEAR(braking_m + target_mps * (time_s - braking_s), distance_m, 1e-6);
            }
        }
    }
    EXPECT_GT(braking, 5);
}

class SpeedAdvice : public testing::TestWithParam<const char*> {
protected:
    static std::vector<std::string> advised(std::vector<std::string> settings) {
        settings.emplace_back("driver.speed_advice.mode=glosa");
        return settings;
    }
};
INSTANTIATE_TEST_SUITE_P(Fidelities, SpeedAdvice, testing::Values("full", "meso"));

// Without advice, the vehicle stops at the line. With advice, it passes the line without a stop, less than 4 s after
// the start of green.
TEST_P(SpeedAdvice, LetsAVehicleArriveAtGreen) {
    const std::vector<std::string> signal{"signal.first_green=45 s"};
    const Approach without = run(arriving_vehicles(GetParam(), 1, signal));
    ASSERT_LT(without.lowest_mps, kStoppedSpeed_mps) << "the signal must stop a vehicle without advice";
    const Approach with = run(arriving_vehicles(GetParam(), 1, advised(signal)));
    EXPECT_GT(with.lowest_mps, 20.0 / 3.6);
    EXPECT_EQ(with.passed, 1);
    EXPECT_GE(with.first_passage_s, 45.0);
    EXPECT_LT(with.first_passage_s, 49.0);
    EXPECT_FALSE(with.has_violations);
}

// The whole platoon follows its advised leader, and passes in one green that is long enough.
TEST_P(SpeedAdvice, KeepsAPlatoonFromStopping) {
    const std::vector<std::string> signal{"signal.first_green=45 s"};
    const Approach without = run(arriving_vehicles(GetParam(), 8, signal));
    ASSERT_LT(without.lowest_mps, kStoppedSpeed_mps);
    const Approach with = run(arriving_vehicles(GetParam(), 8, advised(signal)));
    EXPECT_GT(with.lowest_mps, 15.0 / 3.6);
    EXPECT_EQ(with.passed, 8);
    EXPECT_FALSE(with.has_violations);
}

// The green is so late that the vehicle would have to drive below the lowest advised speed. It stops at the line then.
TEST_P(SpeedAdvice, KeepsItsLowestSpeedAndItsRange) {
    const std::vector<std::string> late{"signal.first_green=100 s", "driver.speed_advice.min_speed=30 km/h"};
    const Approach stopped = run(arriving_vehicles(GetParam(), 1, advised(late)));
    EXPECT_LT(stopped.lowest_mps, kStoppedSpeed_mps);
    EXPECT_FALSE(stopped.has_violations);
    const std::vector<std::string> near{"signal.first_green=45 s", "driver.speed_advice.range=30 m"};
    EXPECT_LT(run(arriving_vehicles(GetParam(), 1, advised(near))).lowest_mps, kStoppedSpeed_mps)
        << "30 m are too short to slow down early";
}

// A green announced by a controller: the light must be green in all of these ticks.
struct Announcement {
    std::size_t group;
    GreenWindow green;
};

class Announcements : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Controllers, Announcements, testing::Values("fixed_time", "actuated"));

TEST_P(Announcements, ComeTrue) {
    std::vector<std::string> settings{std::string("signal.controller=") + GetParam(),
                                      "signal.phases[2].recall=minimum"};
    if (std::string(GetParam()) == "fixed_time") settings.pop_back();
    const Scenario scenario = load_scenario(STOPLINE_SOURCE_DIR "/scenarios/phases.yaml", settings);
    const Model model = build_model(scenario, 0);
    Simulation simulation(model);
    std::vector<Announcement> open;
    int future_greens = 0;
    while (simulation.time_s() < 400.0) {
        simulation.step();
        const std::int64_t tick = simulation.state().tick;
        SignalState signals = simulation.state().signals;
        std::erase_if(open, [&](const Announcement& one) { return one.green.until_tick <= tick; });
        for (const Announcement& one : open) {
            if (tick < one.green.from_tick) continue;
            ASSERT_EQ(signals.lights[one.group], Light::green) << "group " << one.group << ", tick " << tick;
        }
        if (tick % 10 != 0) continue;
        const SignalPlan& plan = model.signals[0];
        const SignalView view(plan, 0, tick, signals);
        for (int group = 0; group < view.groups(); ++group) {
            const GreenWindow green = plan.controller->next_green(view, group, tick);
            if (!green.is_known()) continue;
            future_greens += green.from_tick > tick ? 1 : 0;
            open.push_back({at(plan.groups[at(group)]), green});
        }
    }
    EXPECT_GT(future_greens, 50);
}

}  // namespace
}  // namespace stopline
