// The conversion of an index to the type that containers take.
#pragma once

#include <concepts>
#include <cstddef>

namespace stopline {

// Returns `index`, which must not be negative, as std::size_t.
constexpr std::size_t at(std::integral auto index) { return static_cast<std::size_t>(index); }

}  // namespace stopline
