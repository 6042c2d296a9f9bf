// Simulations in parallel threads share only their model. Each gives the same result as a simulation that runs alone.
#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "support/track.h"

namespace stopline {
namespace {

using namespace testing_support;

TEST(SideBySide, RunsGiveTheSameHashesAsAlone) {
    Scenario scenario = single_light("petrol_eu4_72kw", "MIX");
    scenario.signal.first_green_s = 25.0;
    scenario.demand.vehicles = 12;
    scenario.network.approach.length_m = 200.0;
    const Model model = build_model(scenario, 0);
    const auto run = [&model](double until_s) {
        Simulation simulation(model);
        simulation.run_until(until_s);
        return simulation.state_hash();
    };
    constexpr int kThreads = 4;
    std::vector<std::uint64_t> parallel_hashes(kThreads);
    std::vector<std::thread> threads;
    for (int k = 0; k < kThreads; ++k) {
        threads.emplace_back([&, k] { parallel_hashes[at(k)] = run(40.0 + k); });
    }
    for (std::thread& thread : threads) thread.join();
    for (int k = 0; k < kThreads; ++k) EXPECT_EQ(parallel_hashes[at(k)], run(40.0 + k)) << k;
    EXPECT_NE(parallel_hashes[0], parallel_hashes[1]);
}

}  // namespace
}  // namespace stopline
