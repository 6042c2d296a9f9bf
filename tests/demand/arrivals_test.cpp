// Tests of arrival processes against their closed forms.
#include "demand/arrivals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

namespace stopline {
namespace {

using Kind = ArrivalProcess::Kind;

constexpr double kHour_s = 3600.0;
constexpr ArrivalProcess kEven{};
constexpr ArrivalProcess kPoisson{Kind::poisson, 1.0, 0.0};
constexpr ArrivalProcess kPlatooned{Kind::platooned, 6.0, 1.8};

ArrivalRate constant_rate(double rate_1ps, double end_s) {
    ArrivalRate rate;
    rate.append(end_s, rate_1ps, rate_1ps);
    return rate;
}

// Returns a rate of 0.1 1/s for 600 s, which then rises to 0.4 1/s within 300 s and is 0 for the last 300 s.
ArrivalRate varying_rate() {
    ArrivalRate rate;
    rate.append(600.0, 0.1, 0.1);
    rate.append(900.0, 0.1, 0.4);
    rate.append(1200.0, 0.0, 0.0);
    return rate;
}

struct Moments {
    double mean = 0.0;
    double variance = 0.0;
};

Moments moments_of(const std::vector<double>& numbers) {
    const auto n = static_cast<double>(numbers.size());
    const double mean = std::accumulate(numbers.begin(), numbers.end(), 0.0) / n;
    double squares = 0.0;
    for (const double number : numbers) squares += (number - mean) * (number - mean);
    return {mean, squares / (n - 1.0)};
}

// Returns the number of times in each of `intervals` equal intervals that cover [from_s, to_s).
std::vector<double> counts_of(const std::vector<double>& times_s, double from_s, double to_s, std::size_t intervals) {
    std::vector<double> counts(intervals, 0.0);
    for (const double time_s : times_s) {
        if (time_s < from_s || time_s >= to_s) continue;
        counts[static_cast<std::size_t>((time_s - from_s) / (to_s - from_s) * static_cast<double>(intervals))] += 1.0;
    }
    return counts;
}

TEST(ArrivalRate, IntegratesAndInvertsPiecesAndGaps) {
    const ArrivalRate rate = varying_rate();
    EXPECT_DOUBLE_EQ(rate.expected(600.0), 60.0);
    EXPECT_DOUBLE_EQ(rate.expected(750.0), 60.0 + 150.0 * 0.175);
    EXPECT_DOUBLE_EQ(rate.expected(900.0), 60.0 + 300.0 * 0.25);
    EXPECT_DOUBLE_EQ(rate.expected(1200.0), 135.0);
    EXPECT_DOUBLE_EQ(rate.rate_1ps(750.0), 0.25);
    EXPECT_DOUBLE_EQ(rate.highest_1ps(), 0.4);
    for (const double time_s : {0.0, 17.0, 600.0, 700.0, 899.0}) {
        EXPECT_NEAR(rate.time_of_s(rate.expected(time_s)), time_s, 1e-9);
    }
    EXPECT_TRUE(std::isinf(rate.time_of_s(136.0)));
}

TEST(EvenArrivals, FollowTheIntegralOfTheRate) {
    const ArrivalRate rate = varying_rate();
    const std::vector<double> times_s = arrival_times(kEven, rate, {1, 3});
    ASSERT_EQ(times_s.size(), 135U);
    const double offset = rate.expected(times_s[0]);
    EXPECT_GE(offset, 0.0);
    EXPECT_LT(offset, 1.0);
    for (std::size_t k = 0; k < times_s.size(); ++k) {
        EXPECT_NEAR(rate.expected(times_s[k]), static_cast<double>(k) + offset, 1e-9) << k;
    }
}

// The headways must have mean and standard deviation 1 / rate, and the share exp(-rate h) must exceed h. The count of
// an interval has a variance equal to its mean.
TEST(PoissonArrivals, HaveExponentialHeadwaysAndPoissonCounts) {
    constexpr double kRate_1ps = 0.25;
    constexpr std::size_t kIntervals = 4000;
    constexpr double kEnd_s = 60.0 * kIntervals;
    const std::vector<double> times_s = arrival_times(kPoisson, constant_rate(kRate_1ps, kEnd_s), {5, 2});
    std::vector<double> headways_s;
    for (std::size_t k = 1; k < times_s.size(); ++k) headways_s.push_back(times_s[k] - times_s[k - 1]);
    const auto n = static_cast<double>(headways_s.size());
    const Moments headway = moments_of(headways_s);
    EXPECT_NEAR(headway.mean * kRate_1ps, 1.0, 4.0 / std::sqrt(n));
    EXPECT_NEAR(headway.variance * kRate_1ps * kRate_1ps, 1.0, 4.0 * std::sqrt(8.0 / n));
    for (const double limit_s : {1.0, 4.0, 10.0}) {
        const double expected = std::exp(-kRate_1ps * limit_s);
        const auto longer = std::count_if(headways_s.begin(), headways_s.end(), [&](double h) { return h > limit_s; });
        EXPECT_NEAR(static_cast<double>(longer) / n, expected, 4.0 * std::sqrt(expected * (1.0 - expected) / n));
    }
    const Moments count = moments_of(counts_of(times_s, 0.0, kEnd_s, kIntervals));
    EXPECT_NEAR(count.mean, 60.0 * kRate_1ps, 4.0 * std::sqrt(60.0 * kRate_1ps / kIntervals));
    EXPECT_NEAR(count.variance / count.mean, 1.0, 4.0 * std::sqrt(2.0 / kIntervals));
}

// Over many seeds, the counts of each interval are Poisson numbers with the integral of the rate as mean, and the
// counts of two intervals do not depend on each other.
TEST(PoissonArrivals, FollowARateThatChangesWithTime) {
    constexpr std::size_t kSeeds = 3000;
    constexpr std::size_t kIntervals = 8;  // of 150 s
    const ArrivalRate rate = varying_rate();
    std::vector<std::vector<double>> counts(kIntervals);
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
        const std::vector<double> of_seed =
            counts_of(arrival_times(kPoisson, rate, {seed, 0}), 0.0, 1200.0, kIntervals);
        for (std::size_t k = 0; k < kIntervals; ++k) counts[k].push_back(of_seed[k]);
    }
    for (std::size_t k = 0; k < kIntervals; ++k) {
        const double from_s = 150.0 * static_cast<double>(k);
        const double expected = rate.expected(from_s + 150.0) - rate.expected(from_s);
        const Moments count = moments_of(counts[k]);
        EXPECT_NEAR(count.mean, expected, 4.0 * std::sqrt(expected / kSeeds)) << k;
        if (expected == 0.0) continue;
        EXPECT_NEAR(count.variance / expected, 1.0, 4.0 * std::sqrt(3.0 / kSeeds)) << k;
    }
    double product = 0.0;
    const Moments first = moments_of(counts[3]);
    const Moments second = moments_of(counts[4]);
    for (std::size_t k = 0; k < kSeeds; ++k) product += (counts[3][k] - first.mean) * (counts[4][k] - second.mean);
    EXPECT_NEAR(product / kSeeds / std::sqrt(first.variance * second.variance), 0.0, 4.0 / std::sqrt(kSeeds));
}

// Cowan's M3: headways are at least platoon_headway_s, the share 1 / platoon_size of them is longer, and platoons have
// the mean size platoon_size. The mean rate is kept.
TEST(PlatoonedArrivals, KeepRateSizeAndHeadway) {
    constexpr double kRate_1ps = 0.2;
    constexpr double kEnd_s = 400.0 * kHour_s;
    const std::vector<double> times_s = arrival_times(kPlatooned, constant_rate(kRate_1ps, kEnd_s), {3, 1});
    const auto n = static_cast<double>(times_s.size());
    // The variance of a count is its mean times the squared coefficient of variation of the headways.
    const double gap_s = kPlatooned.platoon_size * (1.0 / kRate_1ps - kPlatooned.platoon_headway_s);
    const double share = 1.0 / kPlatooned.platoon_size;
    const double variance_s2 = share * (2.0 - share) * gap_s * gap_s;
    const double deviation = std::sqrt(variance_s2 * kRate_1ps * kRate_1ps * n);
    EXPECT_NEAR(n, kRate_1ps * kEnd_s, 4.0 * deviation);
    EXPECT_LT(8.0 * deviation, 0.05 * n);  // the tolerance is small enough to notice a wrong rate
    double platoons = 1.0;
    std::vector<double> gaps_s;
    for (std::size_t k = 1; k < times_s.size(); ++k) {
        const double headway_s = times_s[k] - times_s[k - 1];
        ASSERT_GE(headway_s, kPlatooned.platoon_headway_s - 1e-6);
        if (headway_s < kPlatooned.platoon_headway_s + 1e-6) continue;
        platoons += 1.0;
        gaps_s.push_back(headway_s - kPlatooned.platoon_headway_s);
    }
    EXPECT_NEAR(n / platoons, kPlatooned.platoon_size, 4.0 * kPlatooned.platoon_size / std::sqrt(platoons));
    const Moments gap = moments_of(gaps_s);
    EXPECT_NEAR(std::sqrt(gap.variance) / gap.mean, 1.0, 4.0 * std::sqrt(2.0 / platoons));
}

TEST(PlatoonedArrivals, FollowARateThatChangesWithTime) {
    constexpr std::size_t kSeeds = 3000;
    const ArrivalRate rate = varying_rate();
    std::vector<double> sums(4, 0.0);  // of 300 s each
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
        const std::vector<double> of_seed = counts_of(arrival_times(kPlatooned, rate, {seed, 0}), 0.0, 1200.0, 4);
        for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += of_seed[k];
    }
    for (std::size_t k = 0; k < 3; ++k) {
        const double from_s = 300.0 * static_cast<double>(k);
        const double expected = rate.expected(from_s + 300.0) - rate.expected(from_s);
        const double deviation = std::sqrt(2.0 * kPlatooned.platoon_size * expected / kSeeds);
        EXPECT_NEAR(sums[k] / kSeeds, expected, 4.0 * deviation) << k;
    }
    // After the rate has fallen to 0, at most the rest of one platoon arrives.
    EXPECT_LT(sums[3] / kSeeds, kPlatooned.platoon_size);
}

TEST(CountedArrivals, HaveExactlyTheirNumberWithinTheInterval) {
    for (const ArrivalProcess& process : {kEven, kPoisson, kPlatooned}) {
        for (const std::int64_t vehicles : {0, 1, 7, 150}) {
            const CountedArrivals counted{300.0, 600.0, vehicles, 40};
            const std::vector<double> times_s = counted_arrival_times(process, counted, {9, 4});
            ASSERT_EQ(times_s.size(), static_cast<std::size_t>(vehicles));
            EXPECT_TRUE(std::is_sorted(times_s.begin(), times_s.end()));
            for (const double time_s : times_s) {
                EXPECT_GE(time_s, 300.0);
                EXPECT_LT(time_s, 600.0);
            }
        }
    }
}

// Given the number of vehicles of a Poisson process, the arrivals are uniform: the counts of the halves of the interval
// are binomial.
TEST(CountedArrivals, OfAPoissonProcessAreUniform) {
    constexpr std::size_t kSeeds = 4000;
    std::vector<double> first_half;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
        const std::vector<double> times_s = counted_arrival_times(kPoisson, {0.0, 100.0, 40, 0}, {seed, 0});
        first_half.push_back(counts_of(times_s, 0.0, 100.0, 2)[0]);
    }
    const Moments count = moments_of(first_half);
    EXPECT_NEAR(count.mean, 20.0, 4.0 * std::sqrt(10.0 / kSeeds));
    EXPECT_NEAR(count.variance / 10.0, 1.0, 4.0 * std::sqrt(2.0 / kSeeds));
}

TEST(CountedArrivals, OfPlatoonsKeepHeadwayAndSize) {
    constexpr double kVehicles = 100'000;
    const CountedArrivals counted{0.0, 5.0 * kVehicles, static_cast<std::int64_t>(kVehicles), 0};
    const std::vector<double> times_s = counted_arrival_times(kPlatooned, counted, {2, 0});
    double platoons = 1.0;
    for (std::size_t k = 1; k < times_s.size(); ++k) {
        const double headway_s = times_s[k] - times_s[k - 1];
        ASSERT_GE(headway_s, kPlatooned.platoon_headway_s - 1e-6);
        platoons += headway_s > kPlatooned.platoon_headway_s + 1e-6 ? 1.0 : 0.0;
    }
    EXPECT_NEAR(kVehicles / platoons, kPlatooned.platoon_size, 4.0 * kPlatooned.platoon_size / std::sqrt(platoons));
}

TEST(Arrivals, DependOnSeedAndInletOnly) {
    const ArrivalRate rate = constant_rate(0.2, 1000.0);
    for (const ArrivalProcess& process : {kEven, kPoisson, kPlatooned}) {
        EXPECT_EQ(arrival_times(process, rate, {1, 1}), arrival_times(process, rate, {1, 1}));
        EXPECT_NE(arrival_times(process, rate, {1, 1}), arrival_times(process, rate, {2, 1}));
        EXPECT_NE(arrival_times(process, rate, {1, 1}), arrival_times(process, rate, {1, 2}));
    }
    // A run that lasts longer begins with the same arrivals.
    const std::vector<double> shorter = arrival_times(kPoisson, rate, {1, 1});
    const std::vector<double> longer = arrival_times(kPoisson, constant_rate(0.2, 2000.0), {1, 1});
    ASSERT_LT(shorter.size(), longer.size());
    EXPECT_TRUE(std::equal(shorter.begin(), shorter.end(), longer.begin()));
}

TEST(RandomOrder, IsAPermutation) {
    std::vector<std::int64_t> order = random_order(50, 10, {1, 0});
    EXPECT_FALSE(std::is_sorted(order.begin(), order.end()));
    std::sort(order.begin(), order.end());
    for (std::int64_t k = 0; k < 50; ++k) EXPECT_EQ(order[static_cast<std::size_t>(k)], k);
}

}  // namespace
}  // namespace stopline
