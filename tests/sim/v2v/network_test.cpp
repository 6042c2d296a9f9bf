// Networks with a V2V channel: no overlaps, and the same bits for any number of threads.
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "scenario/build_model.h"
#include "scenario/load_scenario.h"
#include "sim/step/simulation.h"

namespace stopline {
namespace {

constexpr const char* kGilbert = "driver.v2v={channel: gilbert, loss: 10 %, burst: 4";

Scenario small_grid(const std::string& v2v, const std::vector<std::string>& more = {}) {
    std::vector<std::string> overrides{"fidelity=full",     "network.grid.columns=3", "network.grid.rows=3",
                                       "populations=[CDG]", "measure.baseline=CDG",   "step=20 ms",
                                       "driver.v2v=" + v2v};
    overrides.insert(overrides.end(), more.begin(), more.end());
    return load_scenario(STOPLINE_SOURCE_DIR "/scenarios/grid.yaml", overrides);
}

struct RadioCase {
    const char* name;
    const char* v2v;
    const char* max_vehicles;
};

class PartitionsWithV2v : public testing::TestWithParam<RadioCase> {};
INSTANTIATE_TEST_SUITE_P(
    Radio, PartitionsWithV2v,
    testing::Values(RadioCase{"gilbert", "{channel: gilbert, loss: 20 %, burst: 5, jitter: 50 ms}", "none"},
                    RadioCase{"delivery", "{channel: delivery_over_distance, delivery: cv2x_2_subchannels}", "none"},
                    RadioCase{"platoons", "{channel: gilbert, topology: predecessor_and_leader}", "6"}),
    [](const auto& radio) { return std::string(radio.param.name); });

TEST_P(PartitionsWithV2v, AnyNumberOfThreadsGivesTheSameRun) {
    const Scenario scenario =
        small_grid(GetParam().v2v, {std::string("driver.platoon.max_vehicles=") + GetParam().max_vehicles});
    const Model model = build_model(scenario, 0);
    std::vector<std::vector<std::uint64_t>> hashes;
    std::size_t changes = 0;
    for (const int threads : {1, 2, 4}) {
        Simulation simulation(model, threads);
        hashes.emplace_back();
        for (int k = 1; k <= 6; ++k) {
            simulation.run_until(5.0 * k);
            hashes.back().push_back(simulation.state_hash());
        }
        EXPECT_TRUE(simulation.state().records.violations.none());
        changes = simulation.state().records.v2v_mode_changes.size();
    }
    EXPECT_EQ(hashes[0], hashes[1]);
    EXPECT_EQ(hashes[0], hashes[2]);
    EXPECT_GT(changes, 0U) << "no message is lost";
}

// The variable STOPLINE_V2V_NETWORK_S sets the simulated time of the next two tests.
double network_s() {
    const char* const text = std::getenv("STOPLINE_V2V_NETWORK_S");
    return text == nullptr ? 150.0 : std::strtod(text, nullptr);
}

TEST(V2vNetworks, AGridHasNoOverlaps) {
    const Model model = build_model(small_grid(std::string(kGilbert).substr(11) + "}"), 0);
    Simulation simulation(model);
    simulation.run_until(network_s());
    EXPECT_EQ(simulation.state().records.violations.overlaps, 0);
    EXPECT_EQ(simulation.state().records.violations.conflicts, 0);
    EXPECT_GT(simulation.state().records.exited, 50);
    EXPECT_GT(simulation.state().records.v2v_mode_changes.size(), 100U);
}

TEST(V2vNetworks, AnIntersectionHasNoOverlaps) {
    for (const char* population : {"CDG", "P50"}) {
        const Scenario scenario =
            load_scenario(STOPLINE_SOURCE_DIR "/scenarios/intersection.yaml", {std::string(kGilbert) + "}"});
        for (std::size_t k = 0; k < scenario.populations.size(); ++k) {
            if (scenario.populations[k].name != population) continue;
            const Model model = build_model(scenario, k);
            Simulation simulation(model);
            simulation.run_until(network_s());
            EXPECT_EQ(simulation.state().records.violations.overlaps, 0) << population;
            EXPECT_GT(simulation.state().records.exited, 30) << population;
            EXPECT_GT(simulation.state().records.v2v_mode_changes.size(), 20U) << population;
        }
    }
}

}  // namespace
}  // namespace stopline
