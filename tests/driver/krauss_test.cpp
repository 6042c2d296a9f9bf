// Tests of the extensions of the mesoscale car-following model (Krauss): constant power, transient gap, gap tracking
// and catching up.
#include "driver/krauss.h"

#include <gtest/gtest.h>

#include <cmath>

namespace stopline {
namespace {

constexpr double kFar_m = 1e6;
constexpr double kStep_s = 0.1;

Krauss model() {
    Krauss k;
    k.acceleration_mps2 = 2.0;
    k.deceleration_mps2 = 4.5;
    k.reaction_s = 0.9;
    k.standstill_gap_m = 2.95;
    return k;
}

// Returns the speed after `time_s` of free driving from standstill, m/s.
double speed_after(const Krauss& k, double time_s) {
    double speed = 0.0;
    for (int n = 0; n < static_cast<int>(std::lround(time_s / kStep_s)); ++n) {
        speed = next_speed_mps(k, {speed, kFar_m, speed, 0.0, 0.0, 1e3}, 0.0, kStep_s);
    }
    return speed;
}

TEST(Krauss, AcceleratesConstantlyWithoutAPowerLimit) { EXPECT_NEAR(speed_after(model(), 20.0), 40.0, 1e-9); }

// Up to the speed v_p the acceleration is the constant a, and v_p is reached at t = v_p / a. Above v_p the power is
// constant: v dv/dt = a v_p, so v^2 = v_p^2 + 2 a v_p (t - v_p / a).
TEST(Krauss, AcceleratesWithConstantPowerAboveASpeed) {
    Krauss k = model();
    k.constant_power_speed_mps = 5.0;
    for (const double time_s : {5.0, 10.0, 20.0}) {
        EXPECT_NEAR(speed_after(k, time_s), std::sqrt(25.0 + 20.0 * (time_s - 2.5)), 0.06) << time_s;
    }
}

TEST(Krauss, AddsTheTransientGap) {
    Krauss k = model();
    k.transient_gap_s2 = 0.5;
    const double gap_m = k.equilibrium_gap_m(8.0) + 0.5 * 1.5;
    EXPECT_NEAR(safe_speed_mps(k, gap_m, 8.0, 0.5 * 1.5), 8.0, 1e-9);
    EXPECT_NEAR(next_speed_mps(k, {8.0, gap_m, 8.0, 1.5, 0.0, 1e3}, 0.0, kStep_s), 8.0, 1e-9);
    EXPECT_GT(next_speed_mps(k, {8.0, gap_m, 8.0, 0.0, 0.0, 1e3}, 0.0, kStep_s), 8.05);
}

// The leader is faster, and the gap is exactly the standstill gap plus the time gap times the follower's speed. Without
// gap tracking the follower accelerates, so its time gap becomes too short. With gap tracking it keeps its speed.
TEST(Krauss, TracksItsTimeGap) {
    Krauss k = model();
    const double gap_m = k.standstill_gap_m + 5.0 * k.reaction_s;
    const FollowingInput in{5.0, gap_m, 10.0, 0.0, 0.0, 1e3};
    EXPECT_GT(next_speed_mps(k, in, 0.0, kStep_s), 5.05);
    k.gap_tracking = 1.0;
    EXPECT_NEAR(next_speed_mps(k, in, 0.0, kStep_s), 5.0, 1e-9);
    k.constant_distance = true;
    EXPECT_GT(next_speed_mps(k, in, 0.0, kStep_s), 5.05) << "a constant distance has no time gap";
}

TEST(Krauss, CatchesUpOnlyCloseToItsLeader) {
    Krauss k = model();
    k.catch_up_factor = 1.5;
    const double near_m = k.equilibrium_gap_m(5.0) + 1.9;
    const double far_m = k.equilibrium_gap_m(5.0) + 2.1;
    EXPECT_NEAR(next_speed_mps(k, {5.0, near_m, 30.0, 0.0, 0.0, 1e3}, 0.0, kStep_s), 5.3, 1e-9);
    EXPECT_NEAR(next_speed_mps(k, {5.0, far_m, 30.0, 0.0, 0.0, 1e3}, 0.0, kStep_s), 5.2, 1e-9);
}

}  // namespace
}  // namespace stopline
