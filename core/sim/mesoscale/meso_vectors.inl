// Vectors of the mesoscale kernels: loads and stores of the values of a block, and look-up in tables. R is one double,
// or a vector with one double for each slot of a block. All functions have internal linkage (meso_kernels.inl).
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "base/simd/arithmetic.h"
#include "base/simd/simd.h"

namespace stopline {

namespace {

// Number of doubles in a vector register. In all versions but the scalar one, a block has as many slots.
constexpr int kWide = kBatchWidth / 2;
using Wide = PackedOf<double, kWide>;
using Words = Vector<std::uint64_t, kWide>;

template <class To, class From>
STOPLINE_INLINE To same_bits(const From& from) {
    To to;
    static_assert(sizeof to == sizeof from);
    std::memcpy(&to, &from, sizeof to);
    return to;
}

// Converts the numbers of a vector to another type. Vectors of 512 bits are converted by intrinsics, because the
// compiler would convert them in two halves.
template <class To, class From>
STOPLINE_INLINE Vector<To, kWide> converted(const Vector<From, kWide>& from) {
#if defined(__AVX512F__)
    constexpr __mmask8 kAll = 0xff;  // the unmasked intrinsics cause warnings in g++
    if constexpr (kWide == 8 && std::is_same_v<From, float> && std::is_same_v<To, double>) {
        return same_bits<Vector<To, kWide>>(_mm512_maskz_cvtps_pd(kAll, same_bits<__m256>(from)));
    } else if constexpr (kWide == 8 && std::is_same_v<From, double> && std::is_same_v<To, float>) {
        return same_bits<Vector<To, kWide>>(_mm512_maskz_cvtpd_ps(kAll, same_bits<__m512d>(from)));
    } else if constexpr (kWide == 8 && std::is_same_v<From, int> && std::is_same_v<To, double>) {
        return same_bits<Vector<To, kWide>>(_mm512_maskz_cvtepi32_pd(kAll, same_bits<__m256i>(from)));
    } else if constexpr (kWide == 8 && std::is_same_v<From, int> && std::is_same_v<To, std::int64_t>) {
        return same_bits<Vector<To, kWide>>(_mm512_maskz_cvtepi32_epi64(kAll, same_bits<__m256i>(from)));
    }
#endif
    return __builtin_convertvector(from, Vector<To, kWide>);
}

// get() loads the values of one block as R, and put() stores them. They convert between the stored type and double.
template <class R, class Stored>
STOPLINE_INLINE R get(const Stored* from) {
    if constexpr (std::is_same_v<R, double>) {
        return *from;
    } else {
        Vector<Stored, kWide> values;
        std::memcpy(&values, from, sizeof values);
        return packed<kWide>(converted<double, Stored>(values));
    }
}
template <class Stored>
STOPLINE_INLINE void put(Stored* to, double value) {
    *to = static_cast<Stored>(value);
}
template <class Stored>
STOPLINE_INLINE void put(Stored* to, const Wide& value) {
    const auto values = converted<Stored, double>(value.v);
    std::memcpy(to, &values, sizeof values);
}

// Returns the mask of the slots that hold a vehicle.
template <class R>
STOPLINE_INLINE auto occupied_slots(const int* id) {
    if constexpr (std::is_same_v<R, double>) {
        return *id >= 0;
    } else {
        Vector<int, kWide> ids;
        std::memcpy(&ids, id, sizeof ids);
        return typename R::Mask{converted<std::int64_t, int>(ids) >= 0};
    }
}

// Returns true if any float of the block differs from `value`.
template <class R>
STOPLINE_INLINE bool any_differs(const float* floats, float value) {
    if constexpr (std::is_same_v<R, double>) {
        return *floats != value;
    } else {
#if defined(__AVX512VL__)
        if constexpr (kWide == 8) {
            __m256i loaded;
            std::memcpy(&loaded, floats, sizeof loaded);
            return _mm256_cmpneq_epi32_mask(loaded, _mm256_set1_epi32(std::bit_cast<int>(value))) != 0;
        }
#endif
        const auto bits = std::bit_cast<std::uint32_t>(value);
        std::uint32_t loaded[kWide];
        std::memcpy(loaded, floats, sizeof loaded);
        std::uint32_t differences = 0;
        for (const std::uint32_t own_bits : loaded) differences |= own_bits ^ bits;
        return differences != 0;
    }
}

#if defined(__AVX512DQ__)
// Returns the table value of each vehicle's bin. One permutation selects from 16 table values. This is faster than one
// load for each vehicle.
template <std::size_t bins>
STOPLINE_INLINE Wide permute_table(const std::array<double, bins>& table, const Wide& bin) {
    const __m512i index = _mm512_cvttpd_epi64(same_bits<__m512d>(bin));
    const auto permute_16 = [&](std::size_t from) STOPLINE_INLINE_LAMBDA {
        const double* const part = table.data() + from;
        return _mm512_permutex2var_pd(_mm512_loadu_pd(part), index, _mm512_loadu_pd(part + 8));
    };
    __m512d values = permute_16(0);
    for (std::size_t from = 16; from < bins; from += 16) {
        const __mmask8 in_range = _mm512_cmpge_epi64_mask(index, _mm512_set1_epi64(static_cast<long long>(from)));
        values = _mm512_mask_mov_pd(values, in_range, permute_16(from));
    }
    return packed<kWide>(same_bits<Vector<double, kWide>>(values));
}
#endif

// Returns the table value of each vehicle's bin. A bin past the end of the table gets the last value.
template <class R, std::size_t bins>
STOPLINE_INLINE R table_value(const std::array<double, bins>& table, const R& bin) {
    const R within = clamped(bin, 0.0, static_cast<double>(bins) - 1.0);
    if constexpr (std::is_same_v<R, double>) {
        return table[static_cast<std::size_t>(within)];
    } else {
#if defined(__AVX512DQ__)
        if constexpr (kWide == 8 && bins % 16 == 0) return permute_table(table, within);
#endif
        R values = 0.0;
        for (int j = 0; j < kWide; ++j) values.v[j] = table[static_cast<std::size_t>(within.v[j])];
        return values;
    }
}

}  // namespace

}  // namespace stopline
