// Behaviour does not depend on the step length. In the single-light scenario with sixty vehicles the times at the stop
// line agree within 0.05 s for steps of 20, 10 and 5 ms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "support/track.h"

namespace stopline {
namespace {

using namespace testing_support;

constexpr int kVehicles = 60;

std::vector<double> stop_line_times(const std::string& policy, double step_s) {
    Scenario scenario = single_light("petrol_eu4_72kw", policy);
    scenario.step_s = step_s;
    scenario.demand.vehicles = kVehicles;
    scenario.network.approach.length_m = 750.0;
    scenario.signal.first_green_s = 260.0;
    scenario.signal.green_s = 130.0;
    const Model model = build_model(scenario, 0);
    Simulation simulation(model);
    simulation.run_until(400.0);
    std::vector<double> times;
    for (const Passage& passage : simulation.state().records.passages) {
        if (passage.from_lane == 0) times.push_back(passage.time_s - 260.0);
    }
    return times;
}

class StepLength : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Policies, StepLength,
                         testing::Values("CDG", "CDG-6m", "CTG-Ref", "CTG-HCM", "CTG-HBS", "SWITCH-1", "SWITCH-2",
                                         "MIX"),
                         as_name);

TEST_P(StepLength, HardlyChangesTheTimesAtTheStopLine) {
    const std::vector<double> fine = stop_line_times(GetParam(), 0.005);
    ASSERT_EQ(fine.size(), std::size_t{kVehicles});
    for (const double step_s : {0.01, 0.02}) {
        const std::vector<double> coarse = stop_line_times(GetParam(), step_s);
        ASSERT_EQ(coarse.size(), fine.size());
        double largest_s = 0.0;
        for (std::size_t k = 0; k < fine.size(); ++k) {
            largest_s = std::max(largest_s, std::fabs(coarse[k] - fine[k]));
        }
        std::printf("%s: times at the stop line with a step of %.0f ms differ from those with 5 ms by up to %.3f s\n",
                    GetParam().c_str(), 1e3 * step_s, largest_s);
        EXPECT_LT(largest_s, 0.05);
    }
}

}  // namespace
}  // namespace stopline
