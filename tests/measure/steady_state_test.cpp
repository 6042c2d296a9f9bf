// Tests of warm-up and collapse detection with synthetic series.
#include "measure/steady_state.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/random.h"

namespace stopline {
namespace {

double noise(std::size_t k) { return random_uniform(7, k, 0, Purpose::dawdle) - 0.5; }

std::vector<double> series_with_ramp(std::size_t ramp, std::size_t count) {
    std::vector<double> values;
    for (std::size_t k = 0; k < count; ++k) {
        const double share = k < ramp ? static_cast<double>(k) / static_cast<double>(ramp) : 1.0;
        values.push_back(100.0 * share + noise(k));
    }
    return values;
}

TEST(WarmUp, EndsWithTheRamp) {
    for (const std::size_t ramp : {10u, 40u, 90u}) {
        const std::size_t found = warm_up(series_with_ramp(ramp, 300));
        EXPECT_GE(found + 5, ramp);
        EXPECT_LE(found, ramp + 10);
    }
}

TEST(WarmUp, IsShortForASteadySeriesAndZeroForAShortSeries) {
    EXPECT_LE(warm_up(series_with_ramp(0, 300)), 150u);
    for (const double value : {5.0, 3.3, 1234.56}) EXPECT_EQ(warm_up(std::vector<double>(334, value)), 0u);
    EXPECT_EQ(warm_up(std::vector<double>{1.0, 2.0, 3.0}), 0u);
    EXPECT_EQ(warm_up({}), 0u);
}

TEST(WarmUp, CanBeFoundInTheSmallestSeries) {
    EXPECT_EQ(warm_up(series_with_ramp(5, kMinWarmUpValues)), 5u);
    EXPECT_EQ(warm_up(series_with_ramp(5, kMinWarmUpValues - 1)), 0u);
}

TEST(Collapse, IsFoundAtTheDrop) {
    std::vector<double> values;
    for (std::size_t k = 0; k < 60; ++k) values.push_back((k < 37 ? 100.0 : 80.0) + 5.0 * noise(k));
    const std::optional<Collapse> found = find_collapse(values, 0.1);
    ASSERT_TRUE(found.has_value());
    EXPECT_EQ(found->index, 37u);
    EXPECT_NEAR(found->before, 100.0, 1.5);
    EXPECT_NEAR(found->after, 80.0, 1.5);
    EXPECT_FALSE(find_collapse(values, 0.3).has_value()) << "a drop of 20 % is below the threshold";
}

TEST(Collapse, RequiresAPermanentDrop) {
    std::vector<double> values(60, 33.0);
    std::fill(values.begin() + 30, values.begin() + 45, 5.0);
    EXPECT_FALSE(find_collapse(values, 0.1).has_value());
    std::fill(values.begin() + 45, values.end(), 5.0);
    EXPECT_TRUE(find_collapse(values, 0.1).has_value());
}

TEST(RiseEnd, IsTheFirstValueNearTheMaximum) {
    EXPECT_EQ(rise_end(std::vector<double>{20.0, 60.0, 91.0, 100.0, 30.0}), 2u);
    EXPECT_EQ(rise_end(std::vector<double>{0.0, 0.0}), 0u);
    EXPECT_EQ(rise_end({}), 0u);
}

TEST(Collapse, IgnoresNoiseAndRises) {
    std::vector<double> steady;
    std::vector<double> rising;
    for (std::size_t k = 0; k < 60; ++k) {
        steady.push_back(100.0 + 30.0 * noise(k));
        rising.push_back((k < 30 ? 80.0 : 100.0) + noise(k));
    }
    EXPECT_FALSE(find_collapse(steady, 0.1).has_value());
    EXPECT_FALSE(find_collapse(rising, 0.1).has_value());
    EXPECT_FALSE(find_collapse(std::vector<double>{5.0, 1.0}, 0.1).has_value());
}

}  // namespace
}  // namespace stopline
