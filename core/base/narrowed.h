// Tables for kernels in single precision. Structures of numbers are templates over the number type: S<double> is what
// settings are compiled to, S<float> what kernels read.
#pragma once

#include <array>
#include <bit>
#include <cstddef>

namespace stopline {

// The same numbers rounded to single precision. S must consist of numbers and arrays of them alone.
template <template <class> class S>
S<float> narrowed(const S<double>& wide) {
    constexpr std::size_t kNumbers = sizeof(S<double>) / sizeof(double);
    static_assert(sizeof(S<float>) == kNumbers * sizeof(float));
    const auto doubles = std::bit_cast<std::array<double, kNumbers>>(wide);
    std::array<float, kNumbers> floats{};
    for (std::size_t k = 0; k < kNumbers; ++k) floats[k] = static_cast<float>(doubles[k]);
    return std::bit_cast<S<float>>(floats);
}

}  // namespace stopline
