// The ladder of driving modes.
#include <gtest/gtest.h>

#include "string_stability/string_limits.h"
#include "v2v/fallback.h"

namespace stopline {
namespace {

constexpr int kHysteresis_ticks = 50;

// One vehicle.
struct FallbackMode {
    FallbackModeOf<double> memory{0.0, 0.0, 0.0};
    int last_tick = 0;

    // Returns true if the mode changes.
    bool update(V2vMode demanded, int tick) {
        memory.ticks += tick - last_tick;
        last_tick = tick;
        return update_mode(memory, number_of(demanded), kHysteresis_ticks) > 0.5;
    }
    V2vMode mode() const { return static_cast<V2vMode>(memory.mode); }
};

TEST(Fallback, FallsAtOnceAndReturnsAfterTheHysteresis) {
    FallbackMode fallback;
    EXPECT_TRUE(fallback.update(V2vMode::radar, 100));
    EXPECT_EQ(fallback.mode(), V2vMode::radar);
    for (int tick = 101; tick < 150; ++tick) EXPECT_FALSE(fallback.update(V2vMode::messages, tick));
    EXPECT_TRUE(fallback.update(V2vMode::messages, 150));
    EXPECT_EQ(fallback.mode(), V2vMode::messages);
}

TEST(Fallback, ReturnsOnlyToTheWorstModeOfTheHysteresis) {
    FallbackMode fallback;
    fallback.update(V2vMode::acc, 100);
    fallback.update(V2vMode::old_messages, 120);
    for (int tick = 121; tick <= 150; ++tick) fallback.update(V2vMode::messages, tick);
    EXPECT_EQ(fallback.mode(), V2vMode::old_messages);
    for (int tick = 151; tick <= 200; ++tick) fallback.update(V2vMode::messages, tick);
    EXPECT_EQ(fallback.mode(), V2vMode::messages);
}

TEST(Fallback, OpensAndClosesTheGapWithoutAJump) {
    constexpr double kSpeed_mps = 14.0;
    constexpr double kStep_s = 0.01;
    TimeGapOf<double> fallback{0.0, 0.0};
    double before_m = 0.0;
    double rate_before_mps = 0.0;
    double opening_mps = 0.0;
    double closing_mps = 0.0;
    for (int tick = 0; tick < 6000; ++tick) {
        update_time_gap(fallback, tick < 3000 ? 1.5 : 0.0, kSpeed_mps, kStep_s);
        const double gap_m = fallback.time_gap_s * kSpeed_mps;
        const double rate_mps = (gap_m - before_m) / kStep_s;
        EXPECT_LT(rate_mps, 1.52);
        EXPECT_GT(rate_mps, -1.02);
        EXPECT_NEAR(rate_mps, rate_before_mps, tick < 5500 ? 0.02 : 0.2) << "the gap changes with a jump at " << tick;
        opening_mps = rate_mps > opening_mps ? rate_mps : opening_mps;
        closing_mps = rate_mps < closing_mps ? rate_mps : closing_mps;
        if (tick == 2999) {
            EXPECT_NEAR(fallback.time_gap_s, 1.5, 0.02);
        }
        before_m = gap_m;
        rate_before_mps = rate_mps;
    }
    EXPECT_GT(opening_mps, 1.4);
    EXPECT_LT(closing_mps, -0.9);
    EXPECT_EQ(fallback.time_gap_s, 0.0) << "the gap stays open";
}

TEST(Fallback, OlderMessagesNeedLongerTimeGaps) {
    EXPECT_DOUBLE_EQ(stable_time_gap_s(0.02), 0.243);
    EXPECT_NEAR(stable_time_gap_s(0.4), 1.113, 1e-3);
    EXPECT_DOUBLE_EQ(stable_time_gap_s(2.0), 1.256);
    for (double age_s = 0.0; age_s < 0.6; age_s += 0.01) {
        EXPECT_LE(stable_time_gap_s(age_s), stable_time_gap_s(age_s + 0.01));
    }
}

// The table of stable_time_gap_s() is the result of the linear analysis, for an ideal radar. A run does not compute it
// again, because that takes a noticeable part of a second.
TEST(Fallback, TheTimeGapsAreThoseOfTheLinearAnalysis) {
    for (const double age_s : {0.02, 0.06, 0.10, 0.15, 0.20, 0.30, 0.44, 0.50}) {
        FollowerModel model;
        model.topology = Topology::leader;
        model.cacc.radar_delay_s = 0.0;
        model.cacc.v2v_delay_s = age_s;
        model.lag_s = 0.1;
        model.leader_lag_s = 0.1;
        EXPECT_NEAR(stable_time_gap_s(age_s), smallest_stable_time_gap_s(model), 0.001) << age_s;
    }
}

}  // namespace
}  // namespace stopline
