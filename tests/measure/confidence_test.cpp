// Tests of confidence intervals against printed tables of Student's distribution and against their definition. t(p, n)
// is the quantile for probability p with n degrees of freedom.
#include "measure/confidence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "base/input_error.h"

namespace stopline {
namespace {

const std::vector<double> kSix{10.0, 12.0, 9.0, 11.0, 13.0, 11.0};  // mean 11, sample deviation sqrt(2)

TEST(Confidence, MatchesStudentsInterval) {
    const Interval band = confidence_interval(kSix, Band::student);
    EXPECT_NEAR(band.high, 11.0 + 2.5706 * std::sqrt(2.0) / std::sqrt(6.0), 1e-4);  // t(0.975, 5)
    EXPECT_NEAR(band.low + band.high, 22.0, 1e-9);
}

TEST(Confidence, MatchesEquation2OfThePaper) {
    const Interval band = confidence_interval(kSix, Band::paper);
    // For n = 6 values: the quantile t(0.95, n), and the root of n / 2 - 1 = 2 as divisor.
    EXPECT_NEAR(band.high, 11.0 + 1.9432 * std::sqrt(2.0) / std::sqrt(2.0), 1e-4);
}

// 95 % of the intervals from samples of six values contain the true mean.
TEST(Confidence, StudentIntervalsHaveTheStatedCoverage) {
    std::mt19937_64 generator(7);
    std::normal_distribution<double> normal(3.0, 2.0);
    int inside = 0;
    constexpr int kSamples = 20'000;
    for (int k = 0; k < kSamples; ++k) {
        std::vector<double> sample(6);
        for (double& value : sample) value = normal(generator);
        inside += confidence_interval(sample, Band::student).contains(3.0) ? 1 : 0;
    }
    EXPECT_NEAR(static_cast<double>(inside) / kSamples, 0.95, 0.006);
}

TEST(Confidence, IsAPointIfAllRunsAgree) {
    const std::vector<double> same(6, 4.25);
    EXPECT_EQ(confidence_interval(same, Band::paper).low, confidence_interval(same, Band::paper).high);
}

TEST(Confidence, RefusesTooFewRuns) {
    const std::vector<double> two{1.0, 2.0};
    EXPECT_THROW(static_cast<void>(confidence_interval(two, Band::paper)), InputError);
    EXPECT_NO_THROW(static_cast<void>(confidence_interval(two, Band::student)));
}

}  // namespace
}  // namespace stopline
