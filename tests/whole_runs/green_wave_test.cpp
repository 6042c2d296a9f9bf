// Green waves: a platoon that fits into the green passes all further signals of a street without a stop if the offset
// of the signals is its travel time from one signal to the next.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <tuple>

#include "base/containers/index.h"
#include "base/speed_thresholds.h"
#include "scenario/build_model.h"
#include "scenario/load_scenario.h"
#include "sim/step/simulation.h"

namespace stopline {
namespace {

constexpr int kVehiclesPerLane = 6;
constexpr double kSpacing_m = 192.5;

struct Drive {
    int left = 0;     // vehicles that have left the network
    int stopped = 0;  // vehicles that have stopped between the first and the last signal
    bool has_violations = false;
};

// Simulates a platoon on each of two lanes of a street with five signals. Both platoons come from the west.
Drive drive(const std::string& fidelity, const std::string& policy, int offset_s) {
    const Scenario scenario = load_scenario(
        STOPLINE_SOURCE_DIR "/scenarios/arterial.yaml",
        {"fidelity=" + fidelity, "populations=[" + policy + "]", "measure.baseline=" + policy, "duration=400 s",
         "measure.window=200 s", "signal.offset=" + std::to_string(offset_s) + " s",
         "demand={kind: queue, vehicles: " + std::to_string(kVehiclesPerLane) + ", approaches: [c0r0_west]}"});
    const Model model = build_model(scenario, 0);
    Simulation simulation(model);
    std::map<int, double> slowest_mps;  // by vehicle id
    while (simulation.time_s() < 400.0) {
        simulation.step();
        const State& state = simulation.state();
        for (std::size_t lane = 0; lane < state.blocks.size(); ++lane) {
            const std::string& name = model.graph.lanes[lane].name;
            if (name.starts_with("c0r0_")) continue;  // the first signal stops the platoons
            const LaneBlock& block = state.blocks[lane];
            for (int slot = block.first; slot < block.past_last(); ++slot) {
                double& slowest = slowest_mps.try_emplace(state.vehicles.id[at(slot)], 1e9).first->second;
                slowest = std::min(slowest, state.vehicles.speed_mps[at(slot)]);
            }
        }
    }
    Drive result;
    result.left = static_cast<int>(slowest_mps.size()) - static_cast<int>(simulation.state().present());
    for (const auto& [vehicle, speed_mps] : slowest_mps) result.stopped += speed_mps < kStoppedSpeed_mps ? 1 : 0;
    result.has_violations = !simulation.state().records.violations.none();
    return result;
}

class GreenWave : public testing::TestWithParam<std::tuple<const char*, const char*>> {};
INSTANTIATE_TEST_SUITE_P(Policies, GreenWave,
                         testing::Combine(testing::Values("meso", "full"), testing::Values("CTG-Ref", "CDG")));

TEST_P(GreenWave, LetsAPlatoonThatFitsPassWithoutAStop) {
    const auto [fidelity, policy] = GetParam();
    constexpr double kSpeed_mps = 50.0 / 3.6;
    const int wave_s = static_cast<int>(kSpacing_m / kSpeed_mps);
    const Drive with_wave = drive(fidelity, policy, wave_s);
    EXPECT_EQ(with_wave.left, 2 * kVehiclesPerLane);
    EXPECT_EQ(with_wave.stopped, 0);
    EXPECT_FALSE(with_wave.has_violations);
    // Against the wave, the second signal has just turned red when the platoons arrive.
    constexpr int kAgainst_s = 38;
    const Drive against = drive(fidelity, policy, kAgainst_s);
    EXPECT_EQ(against.left, 2 * kVehiclesPerLane);
    EXPECT_GT(against.stopped, 0);
}

}  // namespace
}  // namespace stopline
