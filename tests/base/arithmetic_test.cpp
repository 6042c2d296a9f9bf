// Compares the fast approximations in the kernels (the loops over all vehicles) with the exact functions of the
// standard library.
#include "base/simd/arithmetic.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace stopline {
namespace {

TEST(ExpNegative, KeepsItsErrorBounds) {
    for (double x = 0.0; x <= 60.0; x += 1.0 / 1024.0) {
        ASSERT_NEAR(exp_negative(x), std::exp(-x), 3e-7) << x;
        if (x <= 2.0) {
            ASSERT_NEAR(exp_negative(x) / std::exp(-x), 1.0, 1e-7) << x;
        }
    }
    EXPECT_EQ(exp_negative(0.0), 1.0);
}

// x stands for a time divided by a time constant. The test covers large x too, because time constants come from files
// and may be as short as a millisecond.
TEST(ExpNegative, NeverIncreases) {
    double previous = 1.0;
    for (double x = 0.01; x < 60.0; x += 0.01) {
        const double value = exp_negative(x);
        ASSERT_GE(value, 0.0) << x;
        ASSERT_LE(value, previous) << x;
        previous = value;
    }
    for (const double x : {1e3, 1e6, std::numeric_limits<double>::infinity()}) EXPECT_LT(exp_negative(x), 1e-6);
}

// The leading error term of the second-order approximation is (dt / tau)^3 / 12, with step dt and time constant tau.
TEST(LagShare, HasAnErrorOfThirdOrder) {
    for (const double tau : {0.05, 0.1, 0.2, 0.5, 1.0}) {
        for (const double dt : {0.005, 0.01, 0.02, 0.1 * tau}) {
            const double x = dt / tau;
            const double exact = -std::expm1(-x);
            EXPECT_NEAR(lag_share(dt, tau), exact, 1.01 * x * x * x / 12.0 + 1e-15) << tau << ' ' << dt;
            EXPECT_GT(std::fabs(lag_share(dt, tau) - exact), 0.5 * x * x * x / 12.0)
                << "the error is smaller than the stated order";
        }
    }
}

TEST(LagShare, TwoHalfStepsEqualOneStep) {
    for (const double tau : {0.1, 0.2, 0.5}) {
        const double half = 1.0 - lag_share(0.005, tau);
        const double x = 0.01 / tau;
        EXPECT_NEAR(1.0 - half * half, lag_share(0.01, tau), 1.01 * x * x * x / 12.0);
    }
}

TEST(FlushTiny, ZeroesOnlyValuesBelowTheThreshold) {
    for (const double value : {1.0, -1.0, 1e-11, -1e-11, 1e300}) EXPECT_EQ(flush_tiny(value), value);
    for (const double value : {0.0, 9e-13, -9e-13, 1e-200, 5e-324}) EXPECT_EQ(flush_tiny(value), 0.0);
}

TEST(Clamped, AgreesWithFminAndFmax) {
    for (const double value : {-3.0, -1.0, 0.0, 0.5, 1.0, 7.0}) {
        EXPECT_EQ(clamped(value, -1.0, 1.0), std::fmax(-1.0, std::fmin(1.0, value)));
        EXPECT_EQ(min_of(value, 0.5), std::fmin(value, 0.5));
        EXPECT_EQ(max_of(value, 0.5), std::fmax(value, 0.5));
    }
}

TEST(InterpolateOnGrid, IsLinearBetweenNodesAndConstantBeyond) {
    const std::array<double, 8> table{3.0, 1.0, 4.0, 1.0, 5.0, 9.0, 2.0, 6.0};
    for (std::size_t k = 0; k + 1 < table.size(); ++k) {
        for (double share = 0.0; share <= 1.0; share += 0.125) {
            const double expected = table[k] + share * (table[k + 1] - table[k]);
            EXPECT_NEAR(interpolate_on_grid(table, static_cast<double>(k) + share), expected, 1e-14);
        }
    }
    EXPECT_EQ(interpolate_on_grid(table, -2.0), 3.0);
    EXPECT_EQ(interpolate_on_grid(table, 7.5), 6.0);
    EXPECT_EQ(interpolate_on_grid(table, 1e9), 6.0);
}

}  // namespace
}  // namespace stopline
