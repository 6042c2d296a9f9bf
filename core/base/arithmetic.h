// Small branch-free functions for kernels. They use only operations that IEEE 754 rounds correctly, so that scalar and
// vectorised code give the same bits.
#pragma once

#include <cmath>

#include "base/simd.h"

namespace stopline {

STOPLINE_INLINE double select(bool condition, double yes, double no) { return condition ? yes : no; }
STOPLINE_INLINE double lesser(double a, double b) { return a < b ? a : b; }
STOPLINE_INLINE double greater(double a, double b) { return a > b ? a : b; }
STOPLINE_INLINE double limited(double value, double low, double high) { return lesser(greater(value, low), high); }
STOPLINE_INLINE double square(double value) { return value * value; }

// A decaying state ends in subnormal numbers, which cost ten times as much: zero from here on.
STOPLINE_INLINE double without_tiny(double value) { return std::fabs(value) < 1e-12 ? 0.0 : value; }

// exp(-x) for x >= 0 with a relative error below 1e-8 up to x = 8: a Taylor polynomial of degree 5 at x / 16, squared
// four times. The library's exp has no correctly rounded vector form.
STOPLINE_INLINE double exp_minus(double x) {
    const double y = -lesser(x, 50.0) * (1.0 / 16.0);
    double p = 1.0 + y * (1.0 + y * (0.5 + y * (1.0 / 6.0 + y * (1.0 / 24.0 + y * (1.0 / 120.0)))));
    p = square(square(p));
    return square(square(p));
}

// Share of the way to its target that a first-order lag of time constant tau covers in dt: 1 - exp(-dt / tau), by its
// second-order rational approximation (error (dt / tau)^3 / 12).
STOPLINE_INLINE double lag_share(double dt, double tau) { return dt / (tau + 0.5 * dt); }

}  // namespace stopline
