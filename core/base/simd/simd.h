// Vectorisation of kernels, the functions that compute the motion of many vehicles. The equations of a model are
// written once, as function templates over a number type R:
//
//     double       one vehicle in double precision: for exact results, and to measure the error of Single
//     Single       one vehicle in single precision: the reference for Batch
//     Batch        as many vehicles in single precision as a vector register holds
//
// Single and Batch give the same results to the bit: every operation is correctly rounded (IEEE 754), and the compiler
// neither fuses multiplications with additions nor reorders operations (see the flags in the top CMakeLists.txt).
// Batches are explicit vectors, because compilers silently fail to vectorise a loop that contains a whole model. With
// single precision, a register holds twice as many vehicles as with double precision, and arrays need half the memory.
// Positions and speeds are stored in double precision, because they accumulate small increments.
//
// Each kernel file is compiled once for each instruction set (see sim/CMakeLists.txt), with a batch as wide as a
// register. sim/full_dynamics/full_kernels.cpp selects one of these compiled files at run time. Target attributes on
// the functions of a single compiled file would not work: g++ splits vector operations for the instruction set of the
// file before it reads the attribute.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>

#if defined(__AVX512F__)
#include <immintrin.h>
#endif

#ifndef STOPLINE_BATCH_WIDTH
#define STOPLINE_BATCH_WIDTH 4
#endif

// Marks the functions that kernels call. These functions are always inlined. Otherwise the linker could merge copies of
// a function that were compiled for different instruction sets.
#define STOPLINE_INLINE inline __attribute__((always_inline))
#define STOPLINE_INLINE_LAMBDA __attribute__((always_inline))

#if defined(__GNUC__) && !defined(__clang__)
// -Wpsabi warns that the instruction set determines how a batch is passed to a function. This does not matter here,
// because all functions with batches as parameters are inlined.
#pragma GCC diagnostic ignored "-Wpsabi"
#endif

namespace stopline {

// Number of vehicles in the widest batch. The arrays of vehicle data are padded to a multiple of this number.
inline constexpr int kSimdWidth = 16;
// Number of vehicles in a batch, for the instruction set of the source file that includes this header.
static constexpr int kBatchWidth = STOPLINE_BATCH_WIDTH;

// The vector type of the compiler (GCC, Clang) with kWidth numbers. For kWidth = 1 it is the plain number type.
template <class Number, int kWidth>
struct VectorOf {
    using Type __attribute__((vector_size(kWidth * sizeof(Number)))) = Number;
};
template <class Number>
struct VectorOf<Number, 1> {
    using Type = Number;
};
template <class Number, int kWidth>
using Vector = typename VectorOf<Number, kWidth>::Type;

// The result of comparing two PackedOf: one truth value per element.
template <class Number, int kWidth>
struct MaskOf {
    using Integer = std::conditional_t<sizeof(Number) == 8, std::int64_t, std::int32_t>;
    std::conditional_t<kWidth == 1, bool, Vector<Integer, kWidth>> m;
};
template <int kWidth>
using Mask = MaskOf<float, kWidth>;

// kWidth numbers with arithmetic and comparison operators. A plain number in an expression is first rounded to
// `Number`.
template <class Number, int kWidth>
struct PackedOf {
    using Numbers = Vector<Number, kWidth>;
    using Mask = MaskOf<Number, kWidth>;
    Numbers v;

    PackedOf() = default;
    // NOLINTNEXTLINE(google-explicit-constructor): a plain number is converted to kWidth equal numbers
    STOPLINE_INLINE PackedOf(double number) : v(static_cast<Number>(number) - Numbers{}) {}
    struct FromNumbers {};
    STOPLINE_INLINE PackedOf(const Numbers& numbers, FromNumbers /*unused*/) : v(numbers) {}

    using P = PackedOf;
    friend STOPLINE_INLINE P operator+(const P& a, const P& b) { return {a.v + b.v, FromNumbers{}}; }
    friend STOPLINE_INLINE P operator-(const P& a, const P& b) { return {a.v - b.v, FromNumbers{}}; }
    friend STOPLINE_INLINE P operator*(const P& a, const P& b) { return {a.v * b.v, FromNumbers{}}; }
    friend STOPLINE_INLINE P operator/(const P& a, const P& b) { return {a.v / b.v, FromNumbers{}}; }
    friend STOPLINE_INLINE P operator-(const P& a) { return {-a.v, FromNumbers{}}; }
    STOPLINE_INLINE P& operator+=(const P& b) { return v = v + b.v, *this; }
    STOPLINE_INLINE P& operator*=(const P& b) { return v = v * b.v, *this; }
    friend STOPLINE_INLINE Mask operator<(const P& a, const P& b) { return {a.v < b.v}; }
    friend STOPLINE_INLINE Mask operator>(const P& a, const P& b) { return {a.v > b.v}; }
    friend STOPLINE_INLINE Mask operator<=(const P& a, const P& b) { return {a.v <= b.v}; }
    friend STOPLINE_INLINE Mask operator>=(const P& a, const P& b) { return {a.v >= b.v}; }
    friend STOPLINE_INLINE Mask operator==(const P& a, const P& b) { return {a.v == b.v}; }
};
// kWidth numbers in single precision.
template <int kWidth>
using Packed = PackedOf<float, kWidth>;

using Single = Packed<1>;
using Batch = Packed<kBatchWidth>;

template <class R>
inline constexpr int kWidthOf = sizeof(R) / sizeof(float);
template <class R>
inline constexpr bool kIsPacked = !std::is_same_v<R, double>;

template <int kWidth>
STOPLINE_INLINE Packed<kWidth> packed(const Vector<float, kWidth>& floats) {
    return {floats, typename Packed<kWidth>::FromNumbers{}};
}
template <int kWidth>
STOPLINE_INLINE PackedOf<double, kWidth> packed(const Vector<double, kWidth>& doubles) {
    return {doubles, typename PackedOf<double, kWidth>::FromNumbers{}};
}

// Returns a number or batch whose elements are all equal to `value`.
template <class R>
STOPLINE_INLINE R splat(double value) {
    return R(value);
}

// Returns, for each element separately, `yes` if the condition holds, else `no`.
STOPLINE_INLINE double select(bool condition, double yes, double no) { return condition ? yes : no; }
template <class Number, int kWidth>
STOPLINE_INLINE PackedOf<Number, kWidth> select(const MaskOf<Number, kWidth>& condition,
                                                const PackedOf<Number, kWidth>& yes,
                                                const PackedOf<Number, kWidth>& no) {
    return packed<kWidth>(condition.m ? yes.v : no.v);
}
template <class Number, int kWidth>
STOPLINE_INLINE PackedOf<Number, kWidth> select(bool condition, const PackedOf<Number, kWidth>& yes,
                                                const PackedOf<Number, kWidth>& no) {
    return condition ? yes : no;
}

// A flag is a condition that is stored as a number, 1 for true and 0 for false. Use flags for conditions that are
// combined or used twice: "and" is the product, "or" is the maximum, and "not" is 1 - flag.
#define STOPLINE_FLAG(R, condition) select((condition), splat<R>(1.0), splat<R>(0.0))
template <class R>
STOPLINE_INLINE R choose(const R& flag, const R& yes, const R& no) {
    return select(flag > 0.5, yes, no);
}

// Returns true if the flag of any element is set. Kernels call any() to skip work that no vehicle of the batch needs.
// Skipping this work does not change the results.
STOPLINE_INLINE bool any(double flag) { return flag > 0.5; }
template <int kWidth>
STOPLINE_INLINE bool any(const Packed<kWidth>& flag) {
    if constexpr (kWidth == 1) return flag.v > 0.5F;
#if defined(__AVX512F__)
    if constexpr (kWidth == 16) {
        __m512 flags;
        std::memcpy(&flags, &flag, sizeof flags);
        return _mm512_cmp_ps_mask(flags, _mm512_set1_ps(0.5F), _CMP_GT_OQ) != 0;
    }
#endif
    float highest = 0.0F;
    if constexpr (kWidth > 1) {
        for (int k = 0; k < kWidth; ++k) highest = flag.v[k] > highest ? flag.v[k] : highest;
    }
    return highest > 0.5F;
}

// Returns the flags of a batch as bits. The first element has the lowest bit.
template <int kWidth>
STOPLINE_INLINE std::uint32_t bits_of(const Packed<kWidth>& flag) {
    static_assert(kWidth <= 32);
    if constexpr (kWidth == 1) return flag.v > 0.5F ? 1U : 0U;
#if defined(__AVX512F__)
    if constexpr (kWidth == 16) {
        __m512 flags;
        std::memcpy(&flags, &flag, sizeof flags);
        return _mm512_cmp_ps_mask(flags, _mm512_set1_ps(0.5F), _CMP_GT_OQ);
    }
#endif
    std::uint32_t bits = 0;
    if constexpr (kWidth > 1) {
        for (int k = 0; k < kWidth; ++k) bits |= (flag.v[k] > 0.5F ? 1U : 0U) << static_cast<unsigned>(k);
    }
    return bits;
}

STOPLINE_INLINE double square_root(double value) { return std::sqrt(value); }
template <class Number, int kWidth>
STOPLINE_INLINE PackedOf<Number, kWidth> square_root(const PackedOf<Number, kWidth>& value) {
    if constexpr (kWidth == 1) {
        return packed<1>(std::sqrt(value.v));
    } else {
        PackedOf<Number, kWidth> root{};
        for (int k = 0; k < kWidth; ++k) root.v[k] = std::sqrt(value.v[k]);
        return root;
    }
}

// Returns the integer part of a number in [0, 2^31).
STOPLINE_INLINE double truncated(double value) { return static_cast<double>(static_cast<std::int32_t>(value)); }
template <int kWidth>
STOPLINE_INLINE Packed<kWidth> truncated(const Packed<kWidth>& value) {
    if constexpr (kWidth == 1) {
        return packed<1>(static_cast<float>(static_cast<std::int32_t>(value.v)));
    } else {
        const auto integers = __builtin_convertvector(value.v, Vector<std::int32_t, kWidth>);
        return packed<kWidth>(__builtin_convertvector(integers, Vector<float, kWidth>));
    }
}

}  // namespace stopline
