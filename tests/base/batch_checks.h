// Checks that every helper of simd.h and arithmetic.h gives the same bits for a Batch as for single numbers. One test
// file for each batch width defines STOPLINE_BATCH_WIDTH and includes this file. The compiler splits batches that are
// wider than the machine's registers; their bits must not differ either.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/random.h"
#include "base/simd/arithmetic.h"

namespace stopline {
namespace {

// Returns zeros of both signs, subnormals, thresholds of the helpers, and random numbers of many magnitudes.
std::vector<float> numbers() {
    std::vector<float> values{0.0F,      -0.0F,  1.0F,   -1.0F, 0.5F,   1e-12F, -1e-12F,
                              9.99e-13F, 1e-45F, 2e-40F, 50.0F, 49.99F, 800.0F, 1e6F};
    for (std::uint64_t k = 0; values.size() < 4096; ++k) {
        const double u = random_uniform(1, k, 0, Purpose::dawdle) - 0.5;
        const int exponent = static_cast<int>(random_bits(1, k, 1, Purpose::dawdle) % 40) - 20;
        values.push_back(static_cast<float>(std::ldexp(u, exponent)));
    }
    return values;
}

std::uint32_t bits(float value) { return std::bit_cast<std::uint32_t>(value); }
std::uint32_t bits(const Single& value) { return bits(value.v); }

// Expects the same bits from `f` for batches and for single numbers. The loads are unaligned, as in the kernels.
template <class Function>
void expect_same_bits(const char* expression, Function f) {
    const std::vector<float> x = numbers();
    const std::size_t half = x.size() / 2;
    for (std::size_t k = 0; k + kBatchWidth <= half; k += 1) {
        std::array<float, kBatchWidth> result{};
        const auto a_batch = load<Batch>(x.data() + k);
        const auto b_batch = load<Batch>(x.data() + half + k);
        Batch batch_result{};
        f(a_batch, b_batch, batch_result);
        store(result.data(), batch_result);
        for (std::size_t lane = 0; lane < kBatchWidth; ++lane) {
            const Single a(x[k + lane]);
            const Single b(x[half + k + lane]);
            Single expected = 0.0;
            f(a, b, expected);
            ASSERT_EQ(bits(result[lane]), bits(expected)) << expression << ": a = " << a.v << ", b = " << b.v;
        }
    }
}

// Checks an expression of two numbers a and b of type R. The lambda writes to a reference because a function that is
// not inlined cannot return wide vectors.
#define STOPLINE_CHECK(text, ...) \
    expect_same_bits(             \
        text, []<class R>([[maybe_unused]] const R& a, [[maybe_unused]] const R& b, R& out) { out = __VA_ARGS__; })

void check_batch_arithmetic() {
    STOPLINE_CHECK("sum", a + b);
    STOPLINE_CHECK("product and sum without contraction", a * b + a);
    STOPLINE_CHECK("quotient", a / (b * b + 1.0));
    STOPLINE_CHECK("splat", splat<R>(0.1) + a);
    STOPLINE_CHECK("negation", -a);
    STOPLINE_CHECK("select ==", select(a == 0.0, a, b));
    STOPLINE_CHECK("select <", select(a < b, a, b));
    STOPLINE_CHECK("select >=", select(a >= b, a, b));
    STOPLINE_CHECK("flag", STOPLINE_FLAG(R, a > b));
    STOPLINE_CHECK("choose", choose(STOPLINE_FLAG(R, a <= b), a, b));
    STOPLINE_CHECK("min_of", min_of(a, b));
    STOPLINE_CHECK("min_of number", min_of(a, 0.25));
    STOPLINE_CHECK("max_of", max_of(a, b));
    STOPLINE_CHECK("max_of number", max_of(a, 0.25));
    STOPLINE_CHECK("clamped", clamped(a, -0.5, 0.5));
    STOPLINE_CHECK("square", square(a));
    STOPLINE_CHECK("square_root", square_root(a * a + 0.1));
    STOPLINE_CHECK("flush_tiny", flush_tiny(a));
    STOPLINE_CHECK("exp_negative", exp_negative<R>(square(a)));
    STOPLINE_CHECK("lag_share", lag_share<R>(0.01, square(a) + 0.001));
    STOPLINE_CHECK("truncated", truncated(clamped(square(a), 0.0, 2e9)));
}

// Checks look-ups in a table of distinct entries, at its nodes and between them.
template <std::size_t kEntries>
void check_batch_tables() {
    std::array<float, kEntries> table{};
    for (std::size_t k = 0; k < kEntries; ++k) table[k] = std::sin(static_cast<float>(k)) + 0.1F;
    for (float from = 0.0F; from < static_cast<float>(kEntries) + 3.0F; from += 0.125F) {
        std::array<float, kBatchWidth> found{};
        std::array<float, kBatchWidth> interpolated{};
        std::array<float, kBatchWidth> positions{};
        for (std::size_t lane = 0; lane < kBatchWidth; ++lane) {
            positions[lane] = std::fmod(from + 2.71F * static_cast<float>(lane), static_cast<float>(kEntries) + 3.0F);
        }
        const auto position = load<Batch>(positions.data());
        store(found.data(), look_up(table, truncated(min_of(position, kEntries - 1.0))));
        store(interpolated.data(), interpolate_on_grid(table, position));
        for (std::size_t lane = 0; lane < kBatchWidth; ++lane) {
            const auto n = static_cast<std::size_t>(std::min(static_cast<double>(positions[lane]), kEntries - 1.0));
            EXPECT_EQ(found[lane], table[n]) << positions[lane];
            EXPECT_EQ(bits(interpolated[lane]), bits(interpolate_on_grid(table, Single(positions[lane]))))
                << positions[lane];
        }
    }
}

void check_batch_loads_and_stores() {
    std::array<float, 64> floats{};
    std::array<double, 64> doubles{};
    std::array<int, 64> integers{};
    for (std::size_t k = 0; k < floats.size(); ++k) {
        floats[k] = 0.1F * static_cast<float>(k) - 1.0F;
        doubles[k] = 1000.1 * static_cast<double>(k * k) - 1.0;
        integers[k] = static_cast<int>(k * k) - 100;
    }
    const auto stored = [](const Batch& batch) {
        std::array<float, kBatchWidth> values{};
        store(values.data(), batch);
        return values;
    };
    for (std::size_t k = 0; k + kBatchWidth < floats.size(); ++k) {
        const auto from_float = stored(load<Batch>(floats.data() + k));
        const auto from_double = stored(load<Batch>(doubles.data() + k));
        const auto from_int = stored(load<Batch>(integers.data() + k));
        const auto difference = stored(load_difference<Batch>(doubles.data() + k + 1, doubles.data() + k));
        const auto to_constant = stored(load_difference<Batch>(4e6, doubles.data() + k));
        const auto count = stored(counting_from<Batch>(static_cast<int>(k) - 3));
        for (std::size_t lane = 0; lane < kBatchWidth; ++lane) {
            const std::size_t n = k + lane;
            EXPECT_EQ(from_float[lane], floats[n]);
            EXPECT_EQ(from_double[lane], static_cast<float>(doubles[n]));
            EXPECT_EQ(from_int[lane], static_cast<float>(integers[n]));
            EXPECT_EQ(difference[lane], static_cast<float>(doubles[n + 1] - doubles[n]));
            EXPECT_EQ(difference[lane], load_difference<Single>(&doubles[n + 1], &doubles[n]).v);
            EXPECT_EQ(to_constant[lane], load_difference<Single>(4e6, &doubles[n]).v);
            EXPECT_EQ(count[lane], static_cast<float>(n) - 3.0F);
        }
    }
}

void check_any() {
    for (std::size_t set = 0; set <= kBatchWidth; ++set) {
        std::array<float, kBatchWidth + 1> flags{};
        flags[set] = 1.0F;
        EXPECT_EQ(any(load<Batch>(flags.data())), set < kBatchWidth);
    }
}

}  // namespace
}  // namespace stopline
