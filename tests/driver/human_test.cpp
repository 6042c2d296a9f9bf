// Human drivers: reaction times, estimation errors and the start in the mesoscale mode.
#include "driver/human.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"

namespace stopline {
namespace {

struct DriverRandom {
    int vehicle;
    double now_s;
    double dawdle() const { return 0.0; }
    double driver(std::uint64_t index) const { return keyed_uniform(driver_key(1), vehicle, index); }
    double time_s() const { return now_s; }
};

TEST(HumanDriver, ReactionTimesFillTheirRange) {
    const HumanSettings h;
    double sum_s = 0.0;
    double square_s2 = 0.0;
    constexpr int kDrivers = 20'000;
    for (int k = 0; k < kDrivers; ++k) {
        const double reaction_s = reaction_time_s(h, DriverRandom{k, 0.0}.driver(0));
        ASSERT_GE(reaction_s, h.reaction_s - h.reaction_spread_s);
        ASSERT_LE(reaction_s, h.reaction_s + h.reaction_spread_s);
        sum_s += reaction_s;
        square_s2 += (reaction_s - h.reaction_s) * (reaction_s - h.reaction_s);
    }
    EXPECT_NEAR(sum_s / kDrivers, h.reaction_s, 0.005);
    EXPECT_NEAR(std::sqrt(square_s2 / kDrivers), h.reaction_spread_s / std::sqrt(3.0), 0.003);
}

// The errors have the given standard deviations at every time, also between two random numbers of the process.
TEST(HumanDriver, ErrorsHaveTheirStandardDeviation) {
    const HumanSettings h;
    constexpr double kGap_m = 30.0;
    for (const double time_s : {0.0, 5.0, 10.0, 37.0}) {
        double gap_variance = 0.0;
        double closing_variance = 0.0;
        double mean_m = 0.0;
        constexpr int kDrivers = 20'000;
        for (int k = 0; k < kDrivers; ++k) {
            const HumanView<double> seen = with_errors(h, {kGap_m, 2.0}, 10.0, DriverRandom{k, time_s});
            mean_m += (seen.gap_m - kGap_m) / kDrivers;
            gap_variance += std::pow(seen.gap_m - kGap_m, 2) / kDrivers;
            closing_variance += std::pow(seen.closing_mps - 2.0, 2) / kDrivers;
        }
        EXPECT_NEAR(mean_m, 0.0, 0.05) << time_s;
        EXPECT_NEAR(std::sqrt(gap_variance), h.gap_error * kGap_m, 0.03) << time_s;
        EXPECT_NEAR(std::sqrt(closing_variance), h.closing_error_1ps * kGap_m, 0.006) << time_s;
    }
}

TEST(HumanDriver, ErrorsChangeGraduallyAndVanishAtRest) {
    const HumanSettings h;
    double last_m = with_errors(h, {30.0, 0.0}, 10.0, DriverRandom{3, 0.0}).gap_m;
    double lowest_m = last_m;
    double highest_m = last_m;
    for (int tick = 1; tick < 6000; ++tick) {
        const double gap_m = with_errors(h, {30.0, 0.0}, 10.0, DriverRandom{3, 0.1 * tick}).gap_m;
        ASSERT_LT(std::abs(gap_m - last_m), 0.06) << tick;
        last_m = gap_m;
        lowest_m = std::min(lowest_m, gap_m);
        highest_m = std::max(highest_m, gap_m);
    }
    EXPECT_GT(highest_m - lowest_m, 2.0);
    EXPECT_EQ(with_errors(h, {2.0, 0.0}, 0.0, DriverRandom{3, 5.0}).gap_m, 2.0);
}

// The leader accelerates evenly. A driver at rest starts after its reaction time.
TEST(HumanDriver, StartsAfterItsReactionTime) {
    const HumanSettings h;
    const Human model{Idm{idm_parameters(h.idm, 2.0, 1.0)}, h};
    constexpr double kStep_s = 0.1;
    for (const double acceleration_mps2 : {0.5, 2.0}) {
        for (int vehicle = 0; vehicle < 20; ++vehicle) {
            const double reaction_s = reaction_time_s(h, DriverRandom{vehicle, 0.0}.driver(0));
            double leader_mps = 0.0;
            double gap_m = 2.0;
            double start_s = 0.0;
            while (start_s < 5.0) {
                const DriverRandom random{vehicle, start_s};
                const FollowingInput in{0.0, gap_m, leader_mps, leader_mps > 0.0 ? acceleration_mps2 : 0.0,
                                        0.0, 1e3,   14.0};
                if (Human::following_speed_mps(model, in, random, kStep_s) > kMesoStopSpeed_mps) break;
                leader_mps += acceleration_mps2 * kStep_s;
                gap_m += leader_mps * kStep_s;
                start_s += kStep_s;
            }
            EXPECT_NEAR(start_s, reaction_s, kStep_s) << vehicle;
        }
    }
}

}  // namespace
}  // namespace stopline
