#include "measure/counters.h"

#include <gtest/gtest.h>

#include <cmath>

namespace stopline {
namespace {

TEST(Counter, IncludesTheVehicleThatIsPassing) {
    const Counter counter({3.0, 1.0, 2.0});  // the order does not matter
    EXPECT_EQ(counter.passed(0.0), 0);
    EXPECT_EQ(counter.passed(0.999), 0);
    EXPECT_EQ(counter.passed(1.0), 1);
    EXPECT_EQ(counter.passed(2.5), 2);
    EXPECT_EQ(counter.passed(1e9), 3);
    EXPECT_EQ(counter.total(), 3);
}

TEST(Counter, InterpolatesLinearlyBetweenPassages) {
    const Counter counter({2.0, 4.0, 5.0});
    EXPECT_DOUBLE_EQ(counter.interpolated(0.0), 0.0);
    EXPECT_DOUBLE_EQ(counter.interpolated(1.0), 0.5);
    EXPECT_DOUBLE_EQ(counter.interpolated(2.0), 1.0);
    EXPECT_DOUBLE_EQ(counter.interpolated(3.5), 1.75);
    EXPECT_DOUBLE_EQ(counter.interpolated(5.0), 3.0);
    EXPECT_DOUBLE_EQ(counter.interpolated(50.0), 3.0);
}

TEST(Counter, StaysAtZeroWithoutPassages) {
    const Counter counter({});
    EXPECT_EQ(counter.passed(10.0), 0);
    EXPECT_DOUBLE_EQ(counter.interpolated(10.0), 0.0);
}

TEST(Improvement, IsTheRelativeIncrease) {
    EXPECT_DOUBLE_EQ(improvement_percent(17, 8), 112.5);
    EXPECT_DOUBLE_EQ(improvement_percent(8, 8), 0.0);
    EXPECT_DOUBLE_EQ(improvement_percent(6, 8), -25.0);
    EXPECT_TRUE(std::isnan(improvement_percent(3, 0)));
}

// Returns a counter that a vehicle passes every `headway_s`. With interpolation, its count is time / headway.
Counter steady_counter(double headway_s, int vehicles) {
    std::vector<double> times_s;
    for (int k = 1; k <= vehicles; ++k) times_s.push_back(k * headway_s);
    return Counter(times_s);
}

TEST(MeanImprovement, IsTheHeadwayRatioOfSteadyFlows) {
    // These headways give the limit of Fig. 6. Whole counts would give a higher value, because both counts are rounded
    // down.
    const double mean = mean_improvement_percent(steady_counter(0.5832, 100), steady_counter(1.4532, 40), 10.0, 50.0);
    EXPECT_NEAR(mean, 100.0 * (1.4532 / 0.5832 - 1.0), 1e-9);
}

TEST(MeanImprovement, AveragesOverTime) {
    // The baseline passes one vehicle a second. The fast flow passes two a second for five seconds, then none.
    std::vector<double> times_s;
    for (int k = 1; k <= 10; ++k) times_s.push_back(0.5 * k);
    const Counter fast(times_s);
    const Counter baseline = steady_counter(1.0, 20);
    EXPECT_NEAR(mean_improvement_percent(fast, baseline, 2.0, 5.0), 100.0, 1e-9);
    // From 5 s to 10 s: the mean of 10 / t - 1 is 2 ln 2 - 1.
    EXPECT_NEAR(mean_improvement_percent(fast, baseline, 5.0, 10.0), 100.0 * (2.0 * std::log(2.0) - 1.0), 1e-3);
}

TEST(MeanImprovement, IsNanWithoutAnIntervalOrABaseline) {
    const Counter counter = steady_counter(1.0, 10);
    EXPECT_TRUE(std::isnan(mean_improvement_percent(counter, counter, 5.0, 5.0)));
    EXPECT_TRUE(std::isnan(mean_improvement_percent(counter, counter, 6.0, 5.0)));
    EXPECT_TRUE(std::isnan(mean_improvement_percent(counter, Counter({}), 1.0, 5.0)));
    EXPECT_TRUE(std::isnan(mean_improvement_percent(counter, counter, std::nan(""), 5.0)));
}

}  // namespace
}  // namespace stopline
