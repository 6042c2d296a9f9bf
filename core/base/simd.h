// How kernels are vectorised. A model's equations are written once, as function templates over a number type R:
//
//     double       for closed forms and as the measure of what single precision costs,
//     Single       one vehicle at a time in single precision, the oracle of the batches,
//     Batch        as many vehicles at a time as a register holds.
//
// Single and Batch give the same bits: every operation is one that IEEE 754 rounds correctly, there is no contraction to fused
// multiply-add and no reordering (see the flags in the top CMakeLists.txt). Explicit batches rather than the compiler's
// own vectorisation, which gives up on loops as long as these without a word. Single precision holds twice the vehicles a
// register and half the memory; positions and speeds, which small increments add up to, are kept in double.
//
// A file of kernels is compiled once for each instruction set (see sim/CMakeLists.txt), with a batch as wide as its registers;
// sim/full_kernels.cpp picks one at run time. A target attribute on a function would not do: g++ takes operations on
// vectors apart for the file's target before it looks at the function's.
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

// Functions that kernels are made of: always inlined, so that no copy made for one instruction set can be linked
// into code for another.
#define STOPLINE_INLINE inline __attribute__((always_inline))
#define STOPLINE_INLINE_LAMBDA __attribute__((always_inline))

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wpsabi"  // batches are passed between inlined functions only
#endif

namespace stopline {

// Spans of vehicles are padded to a multiple of this, the widest batch.
inline constexpr int kSimdWidth = 16;
// Vehicles that a kernel of this file treats at once.
static constexpr int kBatchWidth = STOPLINE_BATCH_WIDTH;

// kWidth numbers of a type side by side; with kWidth = 1 the plain type.
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

// What comparing two Packed gives.
template <class Number, int kWidth>
struct MaskOf {
    using Integer = std::conditional_t<sizeof(Number) == 8, std::int64_t, std::int32_t>;
    std::conditional_t<kWidth == 1, bool, Vector<Integer, kWidth>> m;
};
template <int kWidth>
using Mask = MaskOf<float, kWidth>;

// kWidth numbers. Arithmetic with any plain number first rounds that to their precision.
template <class Number, int kWidth>
struct PackedOf {
    using Numbers = Vector<Number, kWidth>;
    using Mask = MaskOf<Number, kWidth>;
    Numbers v;

    PackedOf() = default;
    // NOLINTNEXTLINE(google-explicit-constructor): a plain number stands for as many equal ones
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
// In single precision.
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

// The same number in every lane.
template <class R>
STOPLINE_INLINE R splat(double value) {
    return R(value);
}

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

// Conditions that are joined or used more than once are numbers, 1 for true and 0 for false: and is a product, or the
// greater, not is 1 - x.
#define STOPLINE_FLAG(R, condition) select((condition), splat<R>(1.0), splat<R>(0.0))
template <class R>
STOPLINE_INLINE R choose(const R& flag, const R& yes, const R& no) {
    return select(flag > 0.5, yes, no);
}

// Whether a flag is set anywhere in the batch. Work that no vehicle of a batch needs can be skipped with it: a result that no
// vehicle takes changes no bit.
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
    float most = 0.0F;
    if constexpr (kWidth > 1) {
        for (int k = 0; k < kWidth; ++k) most = flag.v[k] > most ? flag.v[k] : most;
    }
    return most > 0.5F;
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

// Whole part of a number >= 0 and below 2^31.
STOPLINE_INLINE double whole(double value) { return static_cast<double>(static_cast<std::int32_t>(value)); }
template <int kWidth>
STOPLINE_INLINE Packed<kWidth> whole(const Packed<kWidth>& value) {
    if constexpr (kWidth == 1) {
        return packed<1>(static_cast<float>(static_cast<std::int32_t>(value.v)));
    } else {
        const auto integers = __builtin_convertvector(value.v, Vector<std::int32_t, kWidth>);
        return packed<kWidth>(__builtin_convertvector(integers, Vector<float, kWidth>));
    }
}

}  // namespace stopline
