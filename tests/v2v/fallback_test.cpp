// The ladder of driving modes.
#include <gtest/gtest.h>

#include "v2v/fallback.h"

namespace stopline {
namespace {

constexpr int kHysteresis_ticks = 50;

TEST(Fallback, FallsAtOnceAndReturnsAfterTheHysteresis) {
    Fallback fallback;
    EXPECT_TRUE(update_mode(fallback, V2vMode::radar, 100, kHysteresis_ticks));
    EXPECT_EQ(fallback.mode, V2vMode::radar);
    for (int tick = 101; tick < 150; ++tick) {
        EXPECT_FALSE(update_mode(fallback, V2vMode::messages, tick, kHysteresis_ticks));
    }
    EXPECT_TRUE(update_mode(fallback, V2vMode::messages, 150, kHysteresis_ticks));
    EXPECT_EQ(fallback.mode, V2vMode::messages);
}

TEST(Fallback, ReturnsOnlyToTheWorstModeOfTheHysteresis) {
    Fallback fallback;
    update_mode(fallback, V2vMode::acc, 100, kHysteresis_ticks);
    update_mode(fallback, V2vMode::old_messages, 120, kHysteresis_ticks);
    for (int tick = 121; tick <= 150; ++tick) update_mode(fallback, V2vMode::messages, tick, kHysteresis_ticks);
    EXPECT_EQ(fallback.mode, V2vMode::old_messages);
    for (int tick = 151; tick <= 200; ++tick) update_mode(fallback, V2vMode::messages, tick, kHysteresis_ticks);
    EXPECT_EQ(fallback.mode, V2vMode::messages);
}

TEST(Fallback, OpensAndClosesTheGapWithoutAJump) {
    constexpr double kSpeed_mps = 14.0;
    constexpr double kStep_s = 0.01;
    Fallback fallback;
    double before_m = 0.0;
    double rate_before_mps = 0.0;
    double opening_mps = 0.0;
    double closing_mps = 0.0;
    for (int tick = 0; tick < 6000; ++tick) {
        update_time_gap(fallback, tick < 3000 ? 1.5 : 0.0, kSpeed_mps, kStep_s);
        const double gap_m = static_cast<double>(fallback.time_gap_s) * kSpeed_mps;
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
    EXPECT_EQ(fallback.time_gap_s, 0.0F) << "the gap stays open";
}

TEST(Fallback, OlderMessagesNeedLongerTimeGaps) {
    EXPECT_DOUBLE_EQ(stable_time_gap_s(0.02), 0.243);
    EXPECT_NEAR(stable_time_gap_s(0.4), 1.113, 1e-3);
    EXPECT_DOUBLE_EQ(stable_time_gap_s(2.0), 1.256);
    for (double age_s = 0.0; age_s < 0.6; age_s += 0.01) {
        EXPECT_LE(stable_time_gap_s(age_s), stable_time_gap_s(age_s + 0.01));
    }
}

}  // namespace
}  // namespace stopline
