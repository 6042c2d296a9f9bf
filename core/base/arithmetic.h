// Small branch-free functions for kernels, over double or Batch (see simd.h).
#pragma once

#include "base/simd_memory.h"

namespace stopline {

template <class R>
STOPLINE_INLINE R lesser(const R& a, const R& b) {
    return select(a < b, a, b);
}
template <class R>
STOPLINE_INLINE R lesser(const R& a, double b) requires(kIsPacked<R>) {
    return lesser(a, splat<R>(b));
}
template <class R>
STOPLINE_INLINE R greater(const R& a, const R& b) {
    return select(a > b, a, b);
}
template <class R>
STOPLINE_INLINE R greater(const R& a, double b) requires(kIsPacked<R>) {
    return greater(a, splat<R>(b));
}
template <class R, class Low, class High>
STOPLINE_INLINE R limited(const R& value, const Low& low, const High& high) {
    return lesser(greater(value, low), high);
}
template <class R>
STOPLINE_INLINE R square(const R& value) {
    return value * value;
}

// A decaying state ends in subnormal numbers, which cost ten times as much: zero from here on.
template <class R>
STOPLINE_INLINE R without_tiny(const R& value) {
    constexpr double kTiny = 1e-12;
    return select(value * value < kTiny * kTiny, splat<R>(0.0), value);
}

// exp(-x) for x >= 0 with an error below 3e-7 (relative: below 1e-7 up to x = 2): a Taylor polynomial of degree 5 at x / 16,
// to the 16th power. From x = 32 on, where exp(-x) is 1e-14, it stays at 2e-19: the polynomial changes its sign at 35. The
// library's exp has no correctly rounded vector form.
template <class R>
STOPLINE_INLINE R exp_minus(const R& x) {
    const R y = lesser(x, 32.0) * (-1.0 / 16.0);
    R p = 1.0 + y * (1.0 + y * (0.5 + y * (1.0 / 6.0 + y * (1.0 / 24.0 + y * (1.0 / 120.0)))));
    p = square(square(p));
    return square(square(p));
}

// Share of the way to its target that a first-order lag of time constant tau covers in dt: 1 - exp(-dt / tau), by its
// second-order rational approximation (error (dt / tau)^3 / 12).
template <class R>
STOPLINE_INLINE R lag_share(double dt, const R& tau) {
    return dt / (tau + 0.5 * dt);
}

// Linear interpolation in a table over a uniform grid; `at` is in cells, from 0; constant beyond the last node.
template <class R, class Number, std::size_t kEntries>
STOPLINE_INLINE R on_grid(const std::array<Number, kEntries>& node, const R& at) {
    constexpr double kLast = static_cast<double>(kEntries) - 1.0;
    const R within = limited(at, 0.0, kLast);
    const R k = whole(lesser(within, kLast - 1.0));
    const R low = look_up(node, k);
    return low + (within - k) * (look_up(node, R(k + 1.0)) - low);
}

}  // namespace stopline
