// Small branch-free functions for kernels. The number type R is double, Single or Batch (see simd.h).
#pragma once

#include "base/simd/simd_memory.h"

namespace stopline {

template <class R>
STOPLINE_INLINE R min_of(const R& a, const R& b) {
    return select(a < b, a, b);
}
template <class R>
STOPLINE_INLINE R min_of(const R& a, double b) requires(kIsPacked<R>) {
    return min_of(a, splat<R>(b));
}
template <class R>
STOPLINE_INLINE R max_of(const R& a, const R& b) {
    return select(a > b, a, b);
}
template <class R>
STOPLINE_INLINE R max_of(const R& a, double b) requires(kIsPacked<R>) {
    return max_of(a, splat<R>(b));
}
template <class R, class Low, class High>
STOPLINE_INLINE R clamped(const R& value, const Low& low, const High& high) {
    return min_of(max_of(value, low), high);
}
template <class R>
STOPLINE_INLINE R square(const R& value) {
    return value * value;
}

// Returns 0 if the magnitude of the value is below 1e-12, else the value. A decaying value would otherwise become
// subnormal, and arithmetic with subnormal numbers is about ten times slower.
template <class R>
STOPLINE_INLINE R flush_tiny(const R& value) {
    constexpr double kTiny = 1e-12;
    return select(value * value < kTiny * kTiny, splat<R>(0.0), value);
}

// Returns exp(-x) for x >= 0. The absolute error is below 3e-7; the relative error is below 1e-7 up to x = 2.
//
// The method is a Taylor polynomial of degree 5 for exp(-x / 16), raised to the 16th power. For x > 32 the function
// returns the value at x = 32, about 1e-14, because the polynomial changes its sign near x = 35. The exp of the C
// library is not used, because its versions for vectors are not correctly rounded: Single and Batch could give
// different results.
template <class R>
STOPLINE_INLINE R exp_negative(const R& x) {
    const R y = min_of(x, 32.0) * (-1.0 / 16.0);
    R p = 1.0 + y * (1.0 + y * (0.5 + y * (1.0 / 6.0 + y * (1.0 / 24.0 + y * (1.0 / 120.0)))));
    p = square(square(p));
    return square(square(p));
}

// A quantity with first-order lag approaches its target with the time constant `tau`. Returns the part of the remaining
// difference that disappears within `dt`: 1 - exp(-dt / tau), with an error of about (dt / tau)^3 / 12.
template <class R>
STOPLINE_INLINE R lag_share(double dt, const R& tau) {
    return dt / (tau + 0.5 * dt);
}

// Interpolates linearly between the values at the nodes of a uniform grid. `position` is the distance from the first
// node in grid cells. Outside the grid the result is the value of the first or last node.
template <class R, class Number, std::size_t kEntries>
STOPLINE_INLINE R interpolate_on_grid(const std::array<Number, kEntries>& node, const R& position) {
    constexpr double kLast = static_cast<double>(kEntries) - 1.0;
    const R within = clamped(position, 0.0, kLast);
    const R k = truncated(min_of(within, kLast - 1.0));
    const R low = look_up(node, k);
    return low + (within - k) * (look_up(node, R(k + 1.0)) - low);
}

}  // namespace stopline
