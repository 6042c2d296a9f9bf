// The announcement of a platoon to a signal: its members, and the tick at which its rear passes the stop line.
#include "sim/junction/lights/announced_platoon.h"

#include <gtest/gtest.h>

#include <string>
#include <tuple>
#include <vector>

#include "base/containers/index.h"
#include "scenario/build_model.h"
#include "scenario/load_scenario.h"
#include "sim/step/simulation.h"

namespace stopline {
namespace {

constexpr int kVehicles = 8;

Model queue_model(const std::string& fidelity, const std::string& policy) {
    const std::vector<std::string> overrides{"fidelity=" + fidelity, "populations=[" + policy + "]",
                                             "measure.baseline=" + policy, "signal.first_green=80 s",
                                             "demand.vehicles=" + std::to_string(kVehicles)};
    return build_model(load_scenario(STOPLINE_SOURCE_DIR "/scenarios/single_light.yaml", overrides), 0);
}

// Returns the lane with the stop line.
int approach(const Model& model) {
    for (int lane = 0; lane < static_cast<int>(model.graph.lanes.size()); ++lane) {
        if (model.graph.lanes[at(lane)].signal_group >= 0) return lane;
    }
    return -1;
}

// Returns the tick at which the rear of a vehicle has passed the stop line.
std::int64_t rear_passage_tick(Simulation& simulation, const Model& model, int vehicle) {
    const double line_m = model.graph.lanes[at(approach(model))].stop_line_m;
    while (simulation.time_s() < 300.0) {
        const State& state = simulation.state();
        bool is_before = false;
        const LaneBlock& block = state.blocks[at(approach(model))];
        for (int slot = block.first; slot < block.past_last(); ++slot) {
            const VehicleArrays& v = state.vehicles;
            const double rear_m = v.position_m[at(slot)] - static_cast<double>(v.length_m[at(slot)]);
            is_before = is_before || (v.id[at(slot)] == vehicle && rear_m < line_m);
        }
        if (!is_before) return state.tick;
        simulation.step();
    }
    return -1;
}

class AnnouncedPlatoons : public testing::TestWithParam<std::tuple<const char*, const char*>> {};
INSTANTIATE_TEST_SUITE_P(Fidelities, AnnouncedPlatoons,
                         testing::Combine(testing::Values("meso", "full"), testing::Values("CDG", "CTG-Ref")));

// The error is up to a quarter of the time, because the forecast has a simple model of the start.
TEST_P(AnnouncedPlatoons, TheForecastOfAStandingQueueComesTrue) {
    const auto [fidelity, policy] = GetParam();
    const Model model = queue_model(fidelity, policy);
    Simulation simulation(model);
    const int lane = approach(model);
    while (simulation.state().signals.lights[0] != Light::green) simulation.step();
    const AnnouncedPlatoon platoon = announced_platoon(model, simulation.state(), lane, 200.0);
    ASSERT_GE(platoon.rear_tick, 0);
    EXPECT_FALSE(platoon.can_wait) << "the queue starts";
    const LaneBlock& block = simulation.state().blocks[at(lane)];
    const int last = simulation.state().vehicles.id[at(block.last())];
    const double forecast_s = model.time_s(platoon.rear_tick - simulation.state().tick);
    const std::int64_t start_tick = simulation.state().tick;
    const double actual_s = model.time_s(rear_passage_tick(simulation, model, last) - start_tick);
    EXPECT_NEAR(forecast_s, actual_s, 0.25 * actual_s);
}

// While the platoon passes, the forecast approaches the real time.
TEST_P(AnnouncedPlatoons, AMovingPlatoonIsForecastWithinASecond) {
    const auto [fidelity, policy] = GetParam();
    const Model model = queue_model(fidelity, policy);
    Simulation simulation(model);
    const int lane = approach(model);
    while (simulation.state().signals.lights[0] != Light::green) simulation.step();
    int last = -1;
    std::int64_t forecast_tick = -1;
    while (simulation.time_s() < 300.0) {
        const LaneBlock& block = simulation.state().blocks[at(lane)];
        const double line_m = model.graph.lanes[at(lane)].stop_line_m;
        int waiting = 0;
        for (int slot = block.first; slot < block.past_last(); ++slot)
            waiting += simulation.state().vehicles.position_m[at(slot)] <= line_m ? 1 : 0;
        if (waiting == 5) {
            const AnnouncedPlatoon platoon = announced_platoon(model, simulation.state(), lane, 200.0);
            forecast_tick = platoon.rear_tick;
            EXPECT_FALSE(platoon.can_wait) << "the platoon is passing the line";
            last = simulation.state().vehicles.id[at(block.last())];
            break;
        }
        simulation.step();
    }
    ASSERT_GE(forecast_tick, 0);
    const std::int64_t actual_tick = rear_passage_tick(simulation, model, last);
    EXPECT_NEAR(model.time_s(forecast_tick), model.time_s(actual_tick), 1.0);
}

TEST_P(AnnouncedPlatoons, NobodyAnnouncesBeyondTheRange) {
    const auto [fidelity, policy] = GetParam();
    const Model model = queue_model(fidelity, policy);
    Simulation simulation(model);
    while (simulation.state().signals.lights[0] != Light::green) simulation.step();
    EXPECT_GE(announced_platoon(model, simulation.state(), approach(model), 10.0).rear_tick, 0);
    EXPECT_EQ(announced_platoon(model, simulation.state(), approach(model), 0.0).rear_tick, -1);
}

}  // namespace
}  // namespace stopline
