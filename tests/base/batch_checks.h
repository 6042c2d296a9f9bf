// Every helper of simd.h and arithmetic.h over Batch against itself over double, lane by lane, to the bit. Included by one
// test file for each batch width, which defines STOPLINE_BATCH_WIDTH first: widths beyond the machine's registers are split
// by the compiler and must give the same bits too.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/arithmetic.h"
#include "base/random.h"

namespace stopline {
namespace {

// Zeros of both signs, subnormals, the thresholds of the helpers, and 4000 numbers of all sizes.
std::vector<double> numbers() {
    std::vector<double> values{0.0,      -0.0,   1.0,    -1.0, 0.5,   1e-12, -1e-12,
                               9.99e-13, 5e-324, 2e-310, 50.0, 49.99, 800.0, 1e6};
    for (std::uint64_t k = 0; values.size() < 4096; ++k) {
        const double u = random_uniform(1, k, 0, Purpose::dawdle) - 0.5;
        values.push_back(std::ldexp(u, static_cast<int>(random_bits(1, k, 1, Purpose::dawdle) % 40) - 20));
    }
    return values;
}

std::uint64_t bits(double value) { return std::bit_cast<std::uint64_t>(value); }

// Applies f, generic over the number type, to batches and to single numbers. Unaligned: kernels load so too.
template <class Function>
void expect_same_bits(const char* what, Function f) {
    const std::vector<double> x = numbers();
    const std::size_t half = x.size() / 2;
    for (std::size_t k = 0; k + kBatchWidth <= half; k += 1) {
        std::array<double, kBatchWidth> result{};
        const auto a_batch = load<Batch>(x.data() + k);
        const auto b_batch = load<Batch>(x.data() + half + k);
        Batch answer{};
        f(a_batch, b_batch, answer);
        store(result.data(), answer);
        for (std::size_t lane = 0; lane < kBatchWidth; ++lane) {
            const double a = x[k + lane];
            const double b = x[half + k + lane];
            double expected = 0.0;
            f(a, b, expected);
            ASSERT_EQ(bits(result[lane]), bits(expected)) << what << ": a = " << a << ", b = " << b;
        }
    }
}

// The expression over a and b of number type R. It is written to a reference because wide vectors cannot be returned by
// a function that is not inlined.
#define STOPLINE_CHECK(text, ...) \
    expect_same_bits(             \
        text, []<class R>([[maybe_unused]] const R& a, [[maybe_unused]] const R& b, R& out) { out = __VA_ARGS__; })

void check_batch_arithmetic() {
    STOPLINE_CHECK("sum", a + b);
    STOPLINE_CHECK("product and sum: no contraction", a * b + a);
    STOPLINE_CHECK("quotient", a / (b * b + 1.0));
    STOPLINE_CHECK("splat", splat<R>(0.1) + a);
    STOPLINE_CHECK("select <", select(a < b, a, b));
    STOPLINE_CHECK("select >=", select(a >= b, a, b));
    STOPLINE_CHECK("flag", STOPLINE_FLAG(R, a > b));
    STOPLINE_CHECK("choose", choose(STOPLINE_FLAG(R, a <= b), a, b));
    STOPLINE_CHECK("lesser", lesser(a, b));
    STOPLINE_CHECK("lesser number", lesser(a, 0.25));
    STOPLINE_CHECK("greater", greater(a, b));
    STOPLINE_CHECK("greater number", greater(a, 0.25));
    STOPLINE_CHECK("limited", limited(a, -0.5, 0.5));
    STOPLINE_CHECK("square", square(a));
    STOPLINE_CHECK("square_root", square_root(a * a + 0.1));
    STOPLINE_CHECK("without_tiny", without_tiny(a));
    STOPLINE_CHECK("exp_minus", exp_minus<R>(square(a)));
    STOPLINE_CHECK("lag_share", lag_share<R>(0.01, square(a) + 0.001));
    STOPLINE_CHECK("whole", whole(limited(square(a), 0.0, 2e9)));
}

// A table whose entries all differ, looked up at every place and between all of them.
template <std::size_t kEntries>
void check_batch_tables() {
    std::array<double, kEntries> table{};
    for (std::size_t k = 0; k < kEntries; ++k) table[k] = std::sin(static_cast<double>(k)) + 0.1;
    for (double from = 0.0; from < static_cast<double>(kEntries) + 3.0; from += 0.125) {
        std::array<double, kBatchWidth> found{};
        std::array<double, kBatchWidth> between{};
        Batch place = counting_from<Batch>(0.0);
        for (int lane = 0; lane < kBatchWidth; ++lane) place[lane] = std::fmod(from + 2.71 * lane, kEntries + 3.0);
        store(found.data(), look_up<kEntries>(table, whole(lesser(place, kEntries - 1.0))));
        store(between.data(), on_grid(table, place));
        for (int lane = 0; lane < kBatchWidth; ++lane) {
            const auto n = static_cast<std::size_t>(std::min(static_cast<double>(place[lane]), kEntries - 1.0));
            const double one = place[lane];
            EXPECT_EQ(found[static_cast<std::size_t>(lane)], table[n]) << one;
            EXPECT_EQ(bits(between[static_cast<std::size_t>(lane)]), bits(on_grid(table, one))) << one;
        }
    }
}

void check_batch_loads_and_stores() {
    std::array<float, 32> floats{};
    std::array<double, 32> doubles{};
    std::array<int, 32> integers{};
    for (std::size_t k = 0; k < floats.size(); ++k) {
        floats[k] = 0.1F * static_cast<float>(k) - 1.0F;
        doubles[k] = 0.1 * static_cast<double>(k) - 1.0;
        integers[k] = static_cast<int>(k * k) - 100;
    }
    for (std::size_t k = 0; k + kBatchWidth <= floats.size(); ++k) {
        const Batch from_float = load<Batch>(floats.data() + k);
        const Batch from_int = load<Batch>(integers.data() + k);
        const Batch count = counting_from<Batch>(static_cast<double>(k));
        const Batch found = look_up<32>(doubles, count);
        std::array<float, kBatchWidth> stored{};
        store(stored.data(), load<Batch>(doubles.data() + k));
        for (int lane = 0; lane < kBatchWidth; ++lane) {
            const std::size_t n = k + static_cast<std::size_t>(lane);
            float one = 0.0F;
            store(&one, doubles[n]);
            EXPECT_EQ(from_float[lane], load<double>(floats.data() + n));
            EXPECT_EQ(from_int[lane], load<double>(integers.data() + n));
            EXPECT_EQ(count[lane], counting_from<double>(static_cast<double>(n)));
            EXPECT_EQ(found[lane], look_up<32>(doubles, static_cast<double>(n)));
            EXPECT_EQ(stored[static_cast<std::size_t>(lane)], one);
        }
    }
}

}  // namespace
}  // namespace stopline
