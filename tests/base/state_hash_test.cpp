// Tests of the state hash: it changes with any bit, with the order and with a missing value.
#include "base/state_hash.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

namespace stopline {
namespace {

std::uint64_t hash_of(const std::vector<double>& numbers) {
    StateHash hash;
    for (const double number : numbers) hash.add(number);
    return hash.value();
}

const std::vector<double> kNumbers{0.0, 1.0, 13.888888888888889, -3.5, 1e-12, 700.0};

TEST(StateHash, DependsOnTheLastBitOfEveryNumber) {
    std::set<std::uint64_t> hashes{hash_of(kNumbers)};
    for (std::size_t k = 0; k < kNumbers.size(); ++k) {
        std::vector<double> changed = kNumbers;
        changed[k] = std::nextafter(changed[k], 1e300);
        hashes.insert(hash_of(changed));
    }
    EXPECT_EQ(hashes.size(), kNumbers.size() + 1);
}

TEST(StateHash, DependsOnTheOrder) {
    std::set<std::uint64_t> hashes{hash_of(kNumbers)};
    for (std::size_t k = 1; k < kNumbers.size(); ++k) {
        std::vector<double> swapped = kNumbers;
        std::swap(swapped[k - 1], swapped[k]);
        hashes.insert(hash_of(swapped));
    }
    EXPECT_EQ(hashes.size(), kNumbers.size());
}

TEST(StateHash, DependsOnTheSignOfZeroAndOnMissingZeros) {
    EXPECT_NE(hash_of({0.0}), hash_of({-0.0}));
    EXPECT_NE(hash_of({0.0}), hash_of({}));
    EXPECT_NE(hash_of({0.0}), hash_of({0.0, 0.0}));
}

TEST(StateHash, IsRepeatable) {
    EXPECT_EQ(hash_of(kNumbers), hash_of(kNumbers));
    StateHash integers;
    integers.add(-1);
    StateHash wide;
    wide.add(std::int64_t{-1});
    EXPECT_EQ(integers.value(), wide.value());
}

}  // namespace
}  // namespace stopline
