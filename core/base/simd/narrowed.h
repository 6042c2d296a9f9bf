// Conversion of parameter structures to single precision. Such a structure is a template S over the number type. The
// parameters are computed in double precision as S<double>, and kernels read S<float>.
#pragma once

#include <array>
#include <bit>
#include <cstddef>

namespace stopline {

// Returns the structure with every number rounded to single precision. S may contain only numbers and arrays of
// numbers.
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
