// Conversion of an integer to std::size_t, the index type of the standard containers.
#pragma once

#include <concepts>
#include <cstddef>

namespace stopline {

// Returns `index` as std::size_t. `index` must not be negative.
constexpr std::size_t at(std::integral auto index) { return static_cast<std::size_t>(index); }

}  // namespace stopline
