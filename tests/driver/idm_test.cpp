// Closed forms of the intelligent driver model, and of its use in the mesoscale mode.
#include "driver/idm.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace stopline {
namespace {

constexpr double kFar_m = 1e6;
constexpr double kLimit_mps = 50.0 / 3.6;

Idm model() { return {idm_parameters({1.0, 1.5}, 2.0, 1.0)}; }

double equilibrium_gap_m(double speed_mps) {
    return (2.0 + speed_mps) / std::sqrt(1.0 - std::pow(speed_mps / kLimit_mps, 4));
}

TEST(Idm, HasItsEquilibriumGap) {
    for (const double v : {0.0, 2.0, 5.0, 10.0, 13.0}) {
        EXPECT_NEAR(idm_acceleration_mps2(model(), v, 0.0, equilibrium_gap_m(v), kLimit_mps), 0.0, 1e-12) << v;
        const FollowingInput in{v, equilibrium_gap_m(v), v, 0.0, 0.0, 1e3, kLimit_mps};
        EXPECT_NEAR(next_speed_mps(model(), in, 0.0, 0.1), v, 1e-12) << v;
    }
    EXPECT_EQ(model().equilibrium_gap_m(5.0), 7.0);
}

TEST(Idm, AcceleratesFreely) {
    for (const double v : {0.0, 5.0, 10.0, kLimit_mps}) {
        const double expected_mps2 = 1.0 - std::pow(v / kLimit_mps, 4);
        EXPECT_NEAR(idm_acceleration_mps2(model(), v, 0.0, kFar_m, kLimit_mps), expected_mps2, 1e-9) << v;
    }
}

// Behind a stopped leader at the distance v^2 / (2 b), the braking term alone gives the deceleration b.
TEST(Idm, BrakesWithTheComfortableDeceleration) {
    IdmParameters p = model();
    p.time_gap_s = p.standstill_gap_m = 0.0;
    const double v = 5.0;
    EXPECT_NEAR(idm_acceleration_mps2(p, v, v, v * v / (2.0 * 1.5), 1e9), 1.0 - 1.5, 1e-9);
}

// The IDM behind a leader that stops at once would run into it if the steps are long. The bound on contact holds for
// every model, so the follower stops behind the leader.
TEST(Idm, NeverRunsIntoItsLeader) {
    for (const double dt : {0.05, 0.1, 0.5}) {
        double gap_m = 3.0;
        double speed_mps = kLimit_mps;
        for (int k = 0; k < 100; ++k) {
            speed_mps = next_speed_mps(model(), {speed_mps, gap_m, 0.0, 0.0, 0.0, 1e3, kLimit_mps}, 0.0, dt);
            gap_m -= speed_mps * dt;
            ASSERT_GE(gap_m, -1e-9) << dt;
            ASSERT_GE(speed_mps, 0.0);
        }
        EXPECT_EQ(speed_mps, 0.0);
    }
}

// The leader of a platoon slows down and speeds up again. With a high acceleration the IDM is string stable (Treiber,
// Kesting 2013, chapter 15): the lowest speed rises along the platoon.
TEST(Idm, DampsADisturbanceAlongAPlatoon) {
    constexpr int kVehicles = 20;
    constexpr double kStep_s = 0.1;
    constexpr double kSpeed_mps = 12.0;
    const Idm damped{idm_parameters({2.0, 1.5}, 2.0, 1.5)};
    const double gap_m = (2.0 + 1.5 * kSpeed_mps) / std::sqrt(1.0 - std::pow(kSpeed_mps / kLimit_mps, 4));
    std::array<double, kVehicles> position_m{};
    std::array<double, kVehicles> speed_mps{};
    std::array<double, kVehicles> lowest_mps{};
    for (int k = 0; k < kVehicles; ++k) {
        position_m[static_cast<std::size_t>(k)] = -gap_m * k;
        speed_mps[static_cast<std::size_t>(k)] = lowest_mps[static_cast<std::size_t>(k)] = kSpeed_mps;
    }
    for (int tick = 0; tick < 1500; ++tick) {
        const double time_s = tick * kStep_s;
        for (std::size_t k = kVehicles; k-- > 1;) {
            const FollowingInput in{speed_mps[k], position_m[k - 1] - position_m[k], speed_mps[k - 1], 0.0, 0.0, 1e3,
                                    kLimit_mps};
            speed_mps[k] = next_speed_mps(damped, in, 0.0, kStep_s);
        }
        speed_mps[0] = kSpeed_mps - 2.0 * std::clamp(std::min(time_s - 5.0, 15.0 - time_s), 0.0, 1.0);
        for (std::size_t k = 0; k < kVehicles; ++k) {
            position_m[k] += speed_mps[k] * kStep_s;
            lowest_mps[k] = std::min(lowest_mps[k], speed_mps[k]);
        }
    }
    EXPECT_NEAR(lowest_mps[0], 10.0, 1e-9);
    EXPECT_GT(lowest_mps[kVehicles - 1], lowest_mps[1]);
    EXPECT_NEAR(speed_mps[kVehicles - 1], kSpeed_mps, 0.2);
}

}  // namespace
}  // namespace stopline
