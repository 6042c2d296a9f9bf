// Tests of the closed forms for signal times against values computed by hand.
#include "measure/signal_equations.h"

#include <cmath>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "base/input_error.h"

namespace {

using namespace stopline;

TEST(SignalEquations, WebsterCycle) {
    // L = 10 s, Y = 0.6: (15 + 5) / 0.4 = 50 s.
    EXPECT_NEAR(webster_cycle_s(10.0, 0.6), 50.0, 1e-12);
    EXPECT_NEAR(webster_cycle_s(16.0, 0.0), 29.0, 1e-12);
    EXPECT_THROW(static_cast<void>(webster_cycle_s(10.0, kMaxFlowRatioSum)), InputError);
    EXPECT_THROW(static_cast<void>(webster_cycle_s(10.0, 1.2)), InputError);
    EXPECT_THROW(static_cast<void>(webster_cycle_s(10.0, std::nan(""))), InputError);
}

TEST(SignalEquations, FlowRatio) {
    EXPECT_NEAR(flow_ratio(450.0, 1800.0), 0.25, 1e-12);
    EXPECT_THROW(static_cast<void>(flow_ratio(450.0, 0.0)), InputError);
}

TEST(SignalEquations, GreensFollowTheFlowRatios) {
    // 50 s of cycle without 10 s of lost time, shared 2 : 1.
    const std::vector<double> ratios{0.4, 0.2};
    const std::vector<double> greens_s = effective_greens_s(50.0, 10.0, ratios);
    EXPECT_NEAR(greens_s[0], 80.0 / 3.0, 1e-12);
    EXPECT_NEAR(greens_s[1], 40.0 / 3.0, 1e-12);
    const std::vector<double> equal{0.3, 0.3};
    const std::vector<double> same_s = effective_greens_s(60.0, 12.0, equal);
    EXPECT_EQ(same_s[0], same_s[1]);
    EXPECT_NEAR(std::accumulate(same_s.begin(), same_s.end(), 12.0), 60.0, 1e-12);
    const std::vector<double> none{0.0, 0.0};
    EXPECT_NEAR(effective_greens_s(60.0, 12.0, none)[0], 24.0, 1e-12);
}

TEST(SignalEquations, CapacityAndUniformDelay) {
    EXPECT_NEAR(capacity_veh_h(1800.0, 30.0, 90.0), 600.0, 1e-12);
    // C = 90 s, g / C = 1/3, X = 0.75: 45 x (2/3)^2 / (1 - 0.25) = 26.667 s.
    EXPECT_NEAR(uniform_delay_s(90.0, 30.0, 0.75), 80.0 / 3.0, 1e-9);
    // X above 1 counts as 1: 45 x (2/3)^2 / (2/3) = 30 s, half of the red.
    EXPECT_NEAR(uniform_delay_s(90.0, 30.0, 1.3), 30.0, 1e-9);
    EXPECT_EQ(uniform_delay_s(90.0, 90.0, 0.5), 0.0);
}

TEST(SignalEquations, IncrementalDelay) {
    // X = 1, c = 600 veh/h, T = 0.25 h: 225 x sqrt(4 / 150) = 36.742 s.
    EXPECT_NEAR(incremental_delay_s(1.0, 600.0), 36.7423461, 1e-6);
    // X = 0.8, c = 600: 225 x (-0.2 + sqrt(0.04 + 3.2 / 150)) = 10.722 s.
    EXPECT_NEAR(incremental_delay_s(0.8, 600.0), 225.0 * (-0.2 + std::sqrt(0.04 + 3.2 / 150.0)), 1e-9);
    EXPECT_NEAR(incremental_delay_s(0.8, 600.0), 10.7225, 1e-4);
    EXPECT_NEAR(incremental_delay_s(0.0, 600.0), 0.0, 1e-12);
    // Without random arrivals (I = 0), only demand above capacity delays: 1800 T (X - 1).
    EXPECT_NEAR(incremental_delay_s(0.9, 600.0, 0.25, 0.5, 0.0), 0.0, 1e-12);
    EXPECT_NEAR(incremental_delay_s(1.2, 600.0, 0.25, 0.5, 0.0), 90.0, 1e-9);
}

TEST(SignalEquations, DelayGrowsWithSaturation) {
    double uniform_s = -1.0;
    double incremental_s = -1.0;
    for (double saturation = 0.1; saturation < 1.0; saturation += 0.05) {
        EXPECT_GT(uniform_delay_s(80.0, 30.0, saturation), uniform_s);
        EXPECT_GT(incremental_delay_s(saturation, 675.0), incremental_s);
        uniform_s = uniform_delay_s(80.0, 30.0, saturation);
        incremental_s = incremental_delay_s(saturation, 675.0);
    }
}

// The cycle of Webster is close to the minimum of his own approximation, uniform plus random delay.
TEST(SignalEquations, WebsterCycleHasLittleDelay) {
    const double flow_ratio_sum = 0.7;
    const double lost_s = 12.0;
    const auto delay_s = [&](double cycle_s) {
        const double green_s = (cycle_s - lost_s) / 2.0;
        const double demand_veh_h = flow_ratio_sum / 2.0 * 1800.0;
        const double capacity = capacity_veh_h(1800.0, green_s, cycle_s);
        const double saturation = demand_veh_h / capacity;
        if (saturation >= 1.0) return 1e9;
        const double flow_1ps = demand_veh_h / 3600.0;
        return uniform_delay_s(cycle_s, green_s, saturation) +
               saturation * saturation / (2.0 * flow_1ps * (1.0 - saturation));
    };
    double best_s = 1e9;
    for (double cycle_s = 30.0; cycle_s < 200.0; cycle_s += 1.0) best_s = std::min(best_s, delay_s(cycle_s));
    const double webster_s = webster_cycle_s(lost_s, flow_ratio_sum);
    EXPECT_LT(delay_s(webster_s), 1.1 * best_s);
    EXPECT_GT(delay_s(0.5 * webster_s), 1.2 * best_s);
}

TEST(SignalEquations, LevelOfService) {
    EXPECT_EQ(level_of_service(10.0, 0.5), 'A');
    EXPECT_EQ(level_of_service(10.1, 0.5), 'B');
    EXPECT_EQ(level_of_service(20.1, 0.5), 'C');
    EXPECT_EQ(level_of_service(35.1, 0.5), 'D');
    EXPECT_EQ(level_of_service(80.0, 0.5), 'E');
    EXPECT_EQ(level_of_service(80.1, 0.5), 'F');
    EXPECT_EQ(level_of_service(5.0, 1.01), 'F');
}

TEST(SignalEquations, PedestrianGreen) {
    // 14 m at 1.07 m/s take 13.08 s, of which yellow and all red cover 8 s.
    EXPECT_NEAR(pedestrian_green_s(14.0, 3.0, 5.0), 7.0 + 14.0 / 1.07 - 8.0, 1e-12);
    EXPECT_NEAR(pedestrian_green_s(5.0, 3.0, 5.0), 7.0, 1e-12);
}

}  // namespace
