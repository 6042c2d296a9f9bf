// Tests of keyed random numbers: uniform, independent along each part of the key, equal at compile time and run time.
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

// The part of the key that varies. The other parts stay constant.
enum class KeyPart { seed, vehicle, tick };

double draw(KeyPart part, std::uint64_t k, Purpose purpose = Purpose::dawdle) {
    switch (part) {
        case KeyPart::seed:
            return random_uniform(k, 17, 4000, purpose);
        case KeyPart::vehicle:
            return random_uniform(1, k, 4000, purpose);
        case KeyPart::tick:
            return random_uniform(1, 17, k, purpose);
    }
    return -1.0;
}

// Returns Pearson's chi-square statistic over equal cells. Its mean is cells - 1 and its variance 2 (cells - 1).
double chi_square(const std::vector<int>& counts) {
    double total = 0.0;
    for (const int count : counts) total += count;
    const double expected = total / static_cast<double>(counts.size());
    double sum = 0.0;
    for (const int count : counts) sum += (count - expected) * (count - expected) / expected;
    return sum;
}

// Allows five standard deviations. The keys are fixed, so the result repeats. Numbers with a pattern exceed the limit
// by far.
void expect_uniform(const std::vector<int>& counts, const char* subject) {
    const double degrees_of_freedom = static_cast<double>(counts.size()) - 1.0;
    EXPECT_NEAR(chi_square(counts), degrees_of_freedom, 5.0 * std::sqrt(2.0 * degrees_of_freedom)) << subject;
}

class RandomAlongKeyPart : public testing::TestWithParam<KeyPart> {};
INSTANTIATE_TEST_SUITE_P(EveryPartOfTheKey, RandomAlongKeyPart,
                         testing::Values(KeyPart::seed, KeyPart::vehicle, KeyPart::tick));

TEST_P(RandomAlongKeyPart, IsUniform) {
    std::vector<int> counts(256, 0);
    for (int k = 0; k < kDraws; ++k) {
        const double u = draw(GetParam(), static_cast<std::uint64_t>(k));
        ASSERT_GE(u, 0.0);
        ASSERT_LT(u, 1.0);
        ++counts[static_cast<std::size_t>(u * 256.0)];
    }
    expect_uniform(counts, "one number");
}

TEST_P(RandomAlongKeyPart, NeighbouringPairsAreUniform) {
    std::vector<int> counts(1024, 0);
    double previous = draw(GetParam(), 0);
    for (int k = 1; k < kDraws; ++k) {
        const double u = draw(GetParam(), static_cast<std::uint64_t>(k));
        ++counts[static_cast<std::size_t>(u * 32.0) * 32 + static_cast<std::size_t>(previous * 32.0)];
        previous = u;
    }
    expect_uniform(counts, "pairs");
}

TEST_P(RandomAlongKeyPart, IsNotAutocorrelated) {
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

TEST_P(RandomAlongKeyPart, EveryBitIsFair) {
    std::array<int, 64> ones{};
    for (int k = 0; k < kDraws; ++k) {
        const auto n = static_cast<std::uint64_t>(k);
        const std::uint64_t bits = GetParam() == KeyPart::seed      ? random_bits(n, 3, 5, Purpose::turn)
                                   : GetParam() == KeyPart::vehicle ? random_bits(3, n, 5, Purpose::turn)
                                                                    : random_bits(3, 5, n, Purpose::turn);
        for (std::size_t bit = 0; bit < 64; ++bit) ones[bit] += static_cast<int>(bits >> bit & 1U);
    }
    for (std::size_t bit = 0; bit < 64; ++bit) {
        EXPECT_NEAR(ones[bit], 0.5 * kDraws, 5.0 * std::sqrt(0.25 * kDraws)) << "bit " << bit;
    }
}

// One changed bit of the key changes half of the result's bits on average.
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

// Runs use small keys. Distinct keys must give distinct results, also if two parts of the key are swapped.
TEST(Random, SmallKeysDoNotCollide) {
    std::set<std::uint64_t> results;
    std::size_t drawn = 0;
    for (const Purpose purpose : {Purpose::policy, Purpose::turn, Purpose::dawdle, Purpose::insertion}) {
        for (std::uint64_t seed = 0; seed < 12; ++seed) {
            for (std::uint64_t vehicle = 0; vehicle < 12; ++vehicle) {
                for (std::uint64_t tick = 0; tick < 12; ++tick, ++drawn) {
                    results.insert(random_bits(seed, vehicle, tick, purpose));
                }
            }
        }
    }
    EXPECT_EQ(results.size(), drawn);
}

TEST(Random, PurposesAreIndependent) {
    double sum = 0.0;
    for (int k = 0; k < kDraws; ++k) {
        const auto vehicle = static_cast<std::uint64_t>(k);
        sum += (draw(KeyPart::vehicle, vehicle, Purpose::policy) - 0.5) *
               (draw(KeyPart::vehicle, vehicle, Purpose::turn) - 0.5);
    }
    EXPECT_LT(std::fabs(12.0 * sum / kDraws), 5.0 / std::sqrt(kDraws));
}

// The generator uses integer arithmetic only, so every compiler and machine gives the same numbers. mix64(0) is the
// published first word of SplitMix64 with seed 0.
constexpr std::uint64_t kAtCompileTime = random_bits(42, 7, 100, Purpose::vehicle_type);
static_assert(mix64(0) == 0xe220a8397b1dcdafULL);
static_assert(random_uniform(42, 7, 100, Purpose::vehicle_type) < 1.0);

TEST(Random, IsTheSameAtCompileTime) {
    volatile std::uint64_t seed = 42;
    EXPECT_EQ(random_bits(seed, 7, 100, Purpose::vehicle_type), kAtCompileTime);
}

}  // namespace
}  // namespace stopline
