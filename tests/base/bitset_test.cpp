// Tests of Bitset: set bits are visited in ascending order and kept or cleared one by one, across word boundaries.
#include "base/containers/bitset.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

namespace stopline {
namespace {

// Clears each bit whose number is not a multiple of `divisor`. Returns the visited bits in order.
std::vector<std::size_t> retain_multiples(Bitset& bits, std::size_t divisor) {
    std::vector<std::size_t> visited;
    bits.retain_if([&](std::size_t number) {
        visited.push_back(number);
        return number % divisor == 0;
    });
    return visited;
}

TEST(Bitset, VisitsBitsInOrderAndRetainsSome) {
    Bitset bits;
    bits.resize(130);
    for (const std::size_t number : {129U, 64U, 0U, 63U, 65U, 64U}) bits.set(number);
    EXPECT_EQ(retain_multiples(bits, 1), (std::vector<std::size_t>{0, 63, 64, 65, 129}));
    EXPECT_EQ(retain_multiples(bits, 64), (std::vector<std::size_t>{0, 63, 64, 65, 129}));
    EXPECT_EQ(retain_multiples(bits, 1), (std::vector<std::size_t>{0, 64}));
    bits.set(1);
    EXPECT_EQ(retain_multiples(bits, 1), (std::vector<std::size_t>{0, 1, 64}));
}

TEST(Bitset, FindsClearsAndVisitsByWord) {
    Bitset bits;
    bits.resize(192);
    bits.set(3), bits.set(70), bits.set(71), bits.set(191);
    EXPECT_TRUE(bits.has(70));
    EXPECT_FALSE(bits.has(6));  // although bit 70, which has the same place in the next word, is set
    const std::vector<BitsetMask> numbers{{0, 1U << 4U}, {1, 1U << 6U}};
    EXPECT_TRUE(bits.has_any(numbers));  // contains 70
    EXPECT_FALSE(bits.has_any(std::span(numbers).first(1)));
    std::vector<std::size_t> visited;
    bits.retain_if(1, 2, [&](std::size_t number) {
        visited.push_back(number);
        return number == 70;
    });
    EXPECT_EQ(visited, (std::vector<std::size_t>{70, 71}));
    bits.clear_word_of(100);
    EXPECT_EQ(retain_multiples(bits, 1), (std::vector<std::size_t>{3, 191}));
}

}  // namespace
}  // namespace stopline
