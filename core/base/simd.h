// How kernels are vectorised. A model's equations are written once, as function templates over a number type R. With
// R = double they are the plain scalar version, the oracle of the tests; with R = Batch they run eight vehicles at a time.
// Both give the same bits: every operation is one that IEEE 754 rounds correctly, there is no contraction to fused
// multiply-add and no reordering (see the flags in the top CMakeLists.txt). Explicit batches rather than the compiler's
// own vectorisation, which gives up on loops as long as these without a word.
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

#if defined(__AVX512F__)
#include <immintrin.h>
#endif

#ifndef STOPLINE_BATCH_WIDTH
#define STOPLINE_BATCH_WIDTH 2
#endif

// Functions that kernels are made of: always inlined, so that no copy made for one instruction set can be linked
// into code for another.
#define STOPLINE_INLINE inline __attribute__((always_inline))

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wpsabi"  // batches are passed between inlined functions only
#endif

namespace stopline {

// Spans of vehicles are padded to a multiple of this, the widest batch.
inline constexpr int kSimdWidth = 8;
// Vehicles that a kernel of this file treats at once.
static constexpr int kBatchWidth = STOPLINE_BATCH_WIDTH;

using Batch = double __attribute__((vector_size(kBatchWidth * sizeof(double))));
using BatchMask = std::int64_t __attribute__((vector_size(kBatchWidth * sizeof(std::int64_t))));
using FloatBatch = float __attribute__((vector_size(kBatchWidth * sizeof(float))));
using IntBatch = std::int32_t __attribute__((vector_size(kBatchWidth * sizeof(std::int32_t))));

// The same number in every lane.
template <class R>
STOPLINE_INLINE R splat(double value) {
    return R{} + value;
}

template <class R, class Number>
STOPLINE_INLINE R load(const Number* from) {
    if constexpr (sizeof(R) == sizeof(double)) {
        return static_cast<R>(*from);
    } else if constexpr (sizeof(Number) == sizeof(double)) {
        R value;
        std::memcpy(&value, from, sizeof value);
        return value;
    } else if constexpr (static_cast<Number>(0.5) == Number{}) {
        IntBatch value;
        std::memcpy(&value, from, sizeof value);
        return __builtin_convertvector(value, Batch);
    } else {
        FloatBatch value;
        std::memcpy(&value, from, sizeof value);
        return __builtin_convertvector(value, Batch);
    }
}

STOPLINE_INLINE void store(double* to, double value) { *to = value; }
STOPLINE_INLINE void store(float* to, double value) { *to = static_cast<float>(value); }
STOPLINE_INLINE void store(double* to, const Batch& value) { std::memcpy(to, &value, sizeof value); }
STOPLINE_INLINE void store(float* to, const Batch& value) {
    const FloatBatch narrow = __builtin_convertvector(value, FloatBatch);
    std::memcpy(to, &narrow, sizeof narrow);
}

// The numbers first, first + 1, ...
template <class R>
STOPLINE_INLINE R counting_from(double first) {
    if constexpr (sizeof(R) == sizeof(double)) {
        return first;
    } else {
        Batch numbers;
        for (int k = 0; k < kBatchWidth; ++k) numbers[k] = first + k;
        return numbers;
    }
}

STOPLINE_INLINE double select(bool condition, double yes, double no) { return condition ? yes : no; }
STOPLINE_INLINE Batch select(const BatchMask& condition, const Batch& yes, const Batch& no) {
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
STOPLINE_INLINE bool any(const Batch& flag) {
#if defined(__AVX512F__) && STOPLINE_BATCH_WIDTH == 8
    __m512d flags;
    std::memcpy(&flags, &flag, sizeof flags);
    return _mm512_cmp_pd_mask(flags, _mm512_set1_pd(0.5), _CMP_GT_OQ) != 0;
#else
    double most = 0.0;
    for (int k = 0; k < kBatchWidth; ++k) most = flag[k] > most ? flag[k] : most;
    return most > 0.5;
#endif
}

STOPLINE_INLINE double square_root(double value) { return std::sqrt(value); }
STOPLINE_INLINE Batch square_root(const Batch& value) {
    Batch root;
    for (int k = 0; k < kBatchWidth; ++k) root[k] = std::sqrt(value[k]);
    return root;
}

// Whole part of a number >= 0 and below 2^31.
STOPLINE_INLINE double whole(double value) { return static_cast<double>(static_cast<std::int32_t>(value)); }
STOPLINE_INLINE Batch whole(const Batch& value) {
    return __builtin_convertvector(__builtin_convertvector(value, IntBatch), Batch);
}

// table[index] of a table with 8, 16 or 32 entries, the index a whole number. So small a table fits into a few registers of
// AVX-512, and a look-up is one or two permutations. (Its gather instruction is slower than single loads where the processor's
// protection against data sampling is on.)
template <std::size_t kEntries>
STOPLINE_INLINE double look_up(const std::array<double, kEntries>& table, double index) {
    return table[static_cast<std::size_t>(index)];
}
template <std::size_t kEntries>
STOPLINE_INLINE Batch look_up(const std::array<double, kEntries>& table, const Batch& index) {
    static_assert(kEntries == 8 || kEntries == 16 || kEntries == 32);
#if defined(__AVX512DQ__) && STOPLINE_BATCH_WIDTH == 8 && !defined(__clang__)
    const BatchMask k = __builtin_convertvector(index, BatchMask);
    std::array<Batch, kEntries / 8> part;
    std::memcpy(part.data(), table.data(), sizeof part);
    if constexpr (kEntries == 8) return __builtin_shuffle(part[0], k);
    if constexpr (kEntries == 16) return __builtin_shuffle(part[0], part[1], k);
    if constexpr (kEntries == 32) {
        // A permutation takes the index modulo 16.
        const Batch low = __builtin_shuffle(part[0], part[1], k);
        return select(index < 16.0, low, __builtin_shuffle(part[2], part[3], k));
    }
#else
    const IntBatch k = __builtin_convertvector(index, IntBatch);
    Batch found;
    for (int n = 0; n < kBatchWidth; ++n) found[n] = table[static_cast<std::size_t>(k[n])];
    return found;
#endif
}

}  // namespace stopline
