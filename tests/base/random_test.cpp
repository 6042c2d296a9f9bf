// Keyed random numbers: uniform, independent of their neighbours in every part of the key, the same at compile time.
#include "base/random.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <set>
#include <vector>

namespace stopline {
namespace {

constexpr int kDraws = 200'000;

// The part of the key that counts up while the others stay.
enum class Along { seed, vehicle, tick };

double draw(Along along, std::uint64_t k, Purpose purpose = Purpose::dawdle) {
    switch (along) {
        case Along::seed:
            return random_uniform(k, 17, 4000, purpose);
        case Along::vehicle:
            return random_uniform(1, k, 4000, purpose);
        case Along::tick:
            return random_uniform(1, 17, k, purpose);
    }
    return -1.0;
}

// Pearson's statistic of the numbers over equal cells. Its mean is cells - 1, its variance 2 (cells - 1).
double chi_square(const std::vector<int>& counts) {
    double total = 0.0;
    for (const int count : counts) total += count;
    const double expected = total / static_cast<double>(counts.size());
    double sum = 0.0;
    for (const int count : counts) sum += (count - expected) * (count - expected) / expected;
    return sum;
}

// Five standard deviations: the keys are fixed, so a sound generator passes always, and any structure fails by far.
void expect_uniform(const std::vector<int>& counts, const char* what) {
    const double freedom = static_cast<double>(counts.size()) - 1.0;
    EXPECT_NEAR(chi_square(counts), freedom, 5.0 * std::sqrt(2.0 * freedom)) << what;
}

class RandomAlong : public testing::TestWithParam<Along> {};
INSTANTIATE_TEST_SUITE_P(EveryPartOfTheKey, RandomAlong, testing::Values(Along::seed, Along::vehicle, Along::tick));

TEST_P(RandomAlong, IsUniform) {
    std::vector<int> counts(256, 0);
    for (int k = 0; k < kDraws; ++k) {
        const double u = draw(GetParam(), static_cast<std::uint64_t>(k));
        ASSERT_GE(u, 0.0);
        ASSERT_LT(u, 1.0);
        ++counts[static_cast<std::size_t>(u * 256.0)];
    }
    expect_uniform(counts, "one number");
}

TEST_P(RandomAlong, PairsOfNeighboursFillTheSquare) {
    std::vector<int> counts(1024, 0);
    double before = draw(GetParam(), 0);
    for (int k = 1; k < kDraws; ++k) {
        const double u = draw(GetParam(), static_cast<std::uint64_t>(k));
        ++counts[static_cast<std::size_t>(u * 32.0) * 32 + static_cast<std::size_t>(before * 32.0)];
        before = u;
    }
    expect_uniform(counts, "pairs");
}

TEST_P(RandomAlong, IsNotCorrelatedWithThePast) {
    for (const int lag : {1, 2, 3, 4, 8, 64, 100}) {
        double sum = 0.0;
        for (int k = lag; k < kDraws; ++k) {
            sum += (draw(GetParam(), static_cast<std::uint64_t>(k)) - 0.5) *
                   (draw(GetParam(), static_cast<std::uint64_t>(k - lag)) - 0.5);
        }
        const double correlation = 12.0 * sum / (kDraws - lag);
        EXPECT_LT(std::fabs(correlation), 5.0 / std::sqrt(kDraws)) << "lag " << lag;
    }
}

TEST_P(RandomAlong, EveryBitIsFair) {
    std::array<int, 64> ones{};
    for (int k = 0; k < kDraws; ++k) {
        const auto n = static_cast<std::uint64_t>(k);
        const std::uint64_t bits = GetParam() == Along::seed      ? random_bits(n, 3, 5, Purpose::turn)
                                   : GetParam() == Along::vehicle ? random_bits(3, n, 5, Purpose::turn)
                                                                  : random_bits(3, 5, n, Purpose::turn);
        for (std::size_t bit = 0; bit < 64; ++bit) ones[bit] += static_cast<int>(bits >> bit & 1U);
    }
    for (std::size_t bit = 0; bit < 64; ++bit) {
        EXPECT_NEAR(ones[bit], 0.5 * kDraws, 5.0 * std::sqrt(0.25 * kDraws)) << "bit " << bit;
    }
}

// One changed bit anywhere in the key changes half of the result's bits.
TEST(Random, OneBitOfTheKeyChangesHalfTheResult) {
    double changed = 0.0;
    int cases = 0;
    for (std::uint64_t key = 0; key < 50; ++key) {
        const std::uint64_t base = random_bits(key, 7 * key, 13 * key, Purpose::policy);
        for (int bit = 0; bit < 48; ++bit) {
            const std::uint64_t flip = std::uint64_t{1} << bit;
            changed += std::popcount(base ^ random_bits(key ^ flip, 7 * key, 13 * key, Purpose::policy));
            changed += std::popcount(base ^ random_bits(key, (7 * key) ^ flip, 13 * key, Purpose::policy));
            changed += std::popcount(base ^ random_bits(key, 7 * key, (13 * key) ^ flip, Purpose::policy));
            cases += 3;
        }
    }
    EXPECT_NEAR(changed / cases, 32.0, 5.0 * 4.0 / std::sqrt(cases));
}

// Small keys are those that occur: none may give what another one gives, and no part may stand in for another.
TEST(Random, SmallKeysDoNotCollide) {
    std::set<std::uint64_t> seen;
    std::size_t drawn = 0;
    for (const Purpose purpose : {Purpose::policy, Purpose::turn, Purpose::dawdle, Purpose::insertion}) {
        for (std::uint64_t seed = 0; seed < 12; ++seed) {
            for (std::uint64_t vehicle = 0; vehicle < 12; ++vehicle) {
                for (std::uint64_t tick = 0; tick < 12; ++tick, ++drawn) {
                    seen.insert(random_bits(seed, vehicle, tick, purpose));
                }
            }
        }
    }
    EXPECT_EQ(seen.size(), drawn);
}

TEST(Random, PurposesAreIndependent) {
    double sum = 0.0;
    for (int k = 0; k < kDraws; ++k) {
        const auto vehicle = static_cast<std::uint64_t>(k);
        sum += (draw(Along::vehicle, vehicle, Purpose::policy) - 0.5) *
               (draw(Along::vehicle, vehicle, Purpose::turn) - 0.5);
    }
    EXPECT_LT(std::fabs(12.0 * sum / kDraws), 5.0 / std::sqrt(kDraws));
}

// Integer arithmetic only: the compiler and the machine agree, on every machine. The first word of SplitMix64 seeded with 0
// is published with the algorithm.
constexpr std::uint64_t kAtCompileTime = random_bits(42, 7, 100, Purpose::vehicle_type);
static_assert(mix64(0) == 0xe220a8397b1dcdafULL);
static_assert(random_uniform(42, 7, 100, Purpose::vehicle_type) < 1.0);

TEST(Random, IsTheSameAtCompileTime) {
    volatile std::uint64_t seed = 42;
    EXPECT_EQ(random_bits(seed, 7, 100, Purpose::vehicle_type), kAtCompileTime);
}

}  // namespace
}  // namespace stopline
