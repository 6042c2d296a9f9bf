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

// A driver stands closed up behind its leader, and the leader starts. The driver starts after its reaction time.
TEST(HumanDriver, StartsAfterItsReactionTime) {
    constexpr double kStep_s = 0.1;
    constexpr double kReaction_s = 1.0;
    int ticks = next_start_ticks(kStartedLongAgo_ticks, 0.0, 0.0, 0.0);
    EXPECT_EQ(ticks, 0);
    EXPECT_FALSE(waits_to_start(ticks, 0.0, kReaction_s, kStep_s));
    for (int step = 1; step < 10; ++step) {
        ticks = next_start_ticks(ticks, 0.0, 0.2 * step, 0.1 * step);
        EXPECT_TRUE(waits_to_start(ticks, 0.0, kReaction_s, kStep_s)) << step;
    }
    ticks = next_start_ticks(ticks, 0.0, 2.0, 1.0);
    EXPECT_FALSE(waits_to_start(ticks, 0.0, kReaction_s, kStep_s));
}

// A driver drives off until its reaction time has passed, unless its leader becomes slower than itself.
TEST(HumanDriver, DrivesOffForOneReactionTime) {
    EXPECT_EQ(is_driving_off(0.7, 0.8, 1.0, -1.0, 0.1), 0.0);
    EXPECT_EQ(is_driving_off(0.8, 0.8, 1.0, -1.0, 0.1), 1.0);
    EXPECT_EQ(is_driving_off(1.7, 0.8, 1.0, 0.0, 0.1), 1.0);
    EXPECT_EQ(is_driving_off(1.7, 0.8, 1.0, 0.1, 0.1), 0.0);
    EXPECT_EQ(is_driving_off(1.81, 0.8, 1.0, -1.0, 0.1), 0.0);
    EXPECT_EQ(is_driving_off(0.0, 0.0, 1.0, 0.0, 0.1), 0.0) << "the leader stands";
    EXPECT_EQ(is_driving_off(1.0, 0.8, 1.0, 0.0, -0.1), 0.0) << "the gap is too short";
    EXPECT_DOUBLE_EQ(view_age_s(-0.1, 1.0), 0.0);
    EXPECT_DOUBLE_EQ(view_age_s(0.4, 1.0), 0.4);
    EXPECT_DOUBLE_EQ(view_age_s(3.0, 1.0), 1.0);
}

// In equilibrium, leaders 1 to n at 1 to n times the gap have the same effect together as one leader at this gap.
TEST(HumanDriver, KeepsTheSameGapBehindSeveralLeaders) {
    for (const int leaders : {1, 2, 5, 10}) {
        double sum = 0.0;
        for (int n = 1; n <= leaders; ++n) {
            const double factor = several_leaders_factor(leaders);
            sum += idm_interaction(10.0, 0.0, n * 12.0, 2.0 * factor, 10.0 * factor, 0.5);
        }
        EXPECT_NEAR(sum, 1.0, 1e-12) << leaders;
    }
}

// A leader that stops again during the reaction time ends the wait. A driver that has stopped far behind its leader
// stopped for another reason. It does not wait for the start of the leader.
TEST(HumanDriver, WaitsOnlyForALeaderCloseAhead) {
    const int waiting = next_start_ticks(0, 0.0, 1.0, 0.1);
    EXPECT_EQ(waiting, 1);
    EXPECT_EQ(next_start_ticks(waiting, 0.0, 0.0, 0.2), 0);
    EXPECT_EQ(next_start_ticks(kStartedLongAgo_ticks, 0.0, 0.0, 20.0), kStartedLongAgo_ticks);
    EXPECT_FALSE(waits_to_start(kStartedLongAgo_ticks, 0.0, 2.0, 0.01));
}

}  // namespace
}  // namespace stopline
