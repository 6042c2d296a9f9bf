// Memory access of kernels: loads and stores of unaligned arrays, and look-ups in small tables.
#pragma once

#include "base/simd/simd.h"

namespace stopline {

namespace packed_details {

template <int kHalf, int... kLane>
STOPLINE_INLINE Vector<float, 2 * kHalf> join(const Vector<float, kHalf>& low, const Vector<float, kHalf>& high,
                                              std::integer_sequence<int, kLane...> /*lanes*/) {
    return __builtin_shufflevector(low, high, kLane...);
}

// Converts 2 * kHalf numbers from double to single precision. part(0) returns the first half of the numbers as a
// vector, and part(kHalf) returns the second half.
template <int kHalf, class Function>
STOPLINE_INLINE Packed<2 * kHalf> from_doubles(Function part) {
    const auto low = __builtin_convertvector(part(0), Vector<float, kHalf>);
    const auto high = __builtin_convertvector(part(kHalf), Vector<float, kHalf>);
    return packed<2 * kHalf>(join<kHalf>(low, high, std::make_integer_sequence<int, 2 * kHalf>{}));
}

template <class Wide, class Number>
STOPLINE_INLINE Wide read(const Number* from) {
    Wide value;
    std::memcpy(&value, from, sizeof value);
    return value;
}

}  // namespace packed_details

// Reads as many consecutive numbers as R has elements, and converts them to the precision of R.
template <class R, class Number>
STOPLINE_INLINE R load(const Number* from) {
    using namespace packed_details;
    constexpr int kWidth = kWidthOf<R>;
    if constexpr (!kIsPacked<R>) {
        return static_cast<double>(*from);
    } else if constexpr (kWidth == 1) {
        return packed<1>(static_cast<float>(*from));
    } else if constexpr (std::is_same_v<Number, double>) {
        return from_doubles<kWidth / 2>(
            [from](int k) STOPLINE_INLINE_LAMBDA { return read<Vector<double, kWidth / 2>>(from + k); });
    } else if constexpr (std::is_same_v<Number, float>) {
        return packed<kWidth>(read<Vector<float, kWidth>>(from));
    } else {
        return packed<kWidth>(__builtin_convertvector(read<Vector<std::int32_t, kWidth>>(from), Vector<float, kWidth>));
    }
}

// Returns a - b for each element. The subtraction is in double precision: positions on a lane are large numbers with
// small differences, so single precision would lose digits.
template <class R>
STOPLINE_INLINE R load_difference(const double* a, const double* b) {
    using namespace packed_details;
    constexpr int kWidth = kWidthOf<R>;
    if constexpr (kWidth == 1) {
        return packed<1>(static_cast<float>(*a - *b));
    } else {
        using Part = Vector<double, kWidth / 2>;
        return from_doubles<kWidth / 2>([a, b](int k)
                                            STOPLINE_INLINE_LAMBDA { return read<Part>(a + k) - read<Part>(b + k); });
    }
}
template <class R>
STOPLINE_INLINE R load_difference(double a, const double* b) {
    using namespace packed_details;
    constexpr int kWidth = kWidthOf<R>;
    if constexpr (kWidth == 1) {
        return packed<1>(static_cast<float>(a - *b));
    } else {
        using Part = Vector<double, kWidth / 2>;
        return from_doubles<kWidth / 2>([a, b](int k) STOPLINE_INLINE_LAMBDA { return a - read<Part>(b + k); });
    }
}

// Writes the elements of `value` to consecutive memory.
template <int kWidth>
STOPLINE_INLINE void store(float* to, const Packed<kWidth>& value) {
    std::memcpy(to, &value.v, sizeof value.v);
}

// Returns a batch with the elements first, first + 1, and so on. They are exact only below 2^24 (single precision).
template <class R>
STOPLINE_INLINE R counting_from(int first) {
    Vector<std::int32_t, kWidthOf<R>> numbers{};
    if constexpr (kWidthOf<R> == 1) {
        return packed<1>(static_cast<float>(first));
    } else {
        for (int k = 0; k < kWidthOf<R>; ++k) numbers[k] = k;
        numbers = numbers + first;
        return packed<kWidthOf<R>>(__builtin_convertvector(numbers, Vector<float, kWidthOf<R>>));
    }
}

// Returns table[index] for each element of `index`, which must hold whole numbers. The table has 8, 16 or 32 entries,
// so it fits into a few registers of AVX2 and AVX-512. A few permutation instructions then look up all elements at
// once. Gather instructions are not used: on processors with the mitigation against Gather Data Sampling, they are
// slower than single loads.
template <std::size_t kEntries>
STOPLINE_INLINE double look_up(const std::array<double, kEntries>& table, double index) {
    return table[static_cast<std::size_t>(index)];
}
template <std::size_t kEntries, int kWidth>
STOPLINE_INLINE Packed<kWidth> look_up(const std::array<float, kEntries>& table, const Packed<kWidth>& index) {
    static_assert(kEntries == 8 || kEntries == 16 || kEntries == 32);
    using namespace packed_details;
    if constexpr (kWidth == 1) {
        return packed<1>(table[static_cast<std::size_t>(index.v)]);
    } else {
        const auto k = __builtin_convertvector(index.v, Vector<std::int32_t, kWidth>);
#if defined(__AVX2__) && !defined(__clang__)
        // A permutation of one register takes indices modulo kWidth. A permutation of two takes them modulo 2 kWidth.
        if constexpr (kWidth == 16 && kEntries == 8) {
            const auto eight = read<Vector<float, 8>>(table.data());
            const auto twice = join<8>(eight, eight, std::make_integer_sequence<int, 16>{});
            return packed<16>(__builtin_shuffle(twice, k));
        } else if constexpr (kWidth >= 8 && kEntries == 2 * kWidth) {
            const auto low = read<Vector<float, kWidth>>(table.data());
            const auto high = read<Vector<float, kWidth>>(table.data() + kWidth);
            return packed<kWidth>(__builtin_shuffle(low, high, k));
        } else if constexpr (kWidth >= 8) {
            auto found = __builtin_shuffle(read<Vector<float, kWidth>>(table.data()), k);
            for (std::size_t from = kWidth; from < kEntries; from += kWidth) {
                const auto part = __builtin_shuffle(read<Vector<float, kWidth>>(table.data() + from), k);
                found = k >= static_cast<std::int32_t>(from) ? part : found;
            }
            return packed<kWidth>(found);
        }
#endif
        Vector<float, kWidth> found{};
        for (int n = 0; n < kWidth; ++n) found[n] = table[static_cast<std::size_t>(k[n])];
        return packed<kWidth>(found);
    }
}

}  // namespace stopline
