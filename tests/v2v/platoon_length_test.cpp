// The length of platoons.
#include <gtest/gtest.h>

#include "v2v/platoon_length.h"

namespace stopline {
namespace {

TEST(PlatoonLength, FallsWithTheDelay) {
    EXPECT_EQ(stable_platoon_vehicles(0.02), 43);
    EXPECT_EQ(stable_platoon_vehicles(0.05), 17);
    EXPECT_EQ(stable_platoon_vehicles(0.10), 8);
    EXPECT_EQ(stable_platoon_vehicles(0.15), 6);
    for (double delay_s = 0.0; delay_s < 0.5; delay_s += 0.01) {
        EXPECT_GE(stable_platoon_vehicles(delay_s), stable_platoon_vehicles(delay_s + 0.01));
        EXPECT_GE(stable_platoon_vehicles(delay_s), 1);
    }
}

TEST(PlatoonLength, ReadsTheSetting) {
    EXPECT_EQ(max_platoon_vehicles({"none"}, 0.02), 0);
    EXPECT_EQ(max_platoon_vehicles({"8"}, 0.02), 8);
    EXPECT_EQ(max_platoon_vehicles({"by_stability"}, 0.05), 17);
    for (const char* text : {"0", "-3", "8.5", "eight", "8x", "1001"}) {
        EXPECT_EQ(max_platoon_vehicles({text}, 0.02), -1) << text;
    }
}

TEST(PlatoonLength, MeanAgeIsDelayPlusJitterPlusHalfAnInterval) {
    DriverSettings driver;
    EXPECT_FALSE(needs_receivers(driver));
    EXPECT_DOUBLE_EQ(mean_message_age_s(driver, 0.01), 0.02);
    driver.v2v.interval_s = 0.1;
    driver.v2v.jitter_s = 0.02;
    EXPECT_DOUBLE_EQ(mean_message_age_s(driver, 0.0), 0.02 + 0.01 + 0.05);
    EXPECT_TRUE(needs_receivers(driver));
}

}  // namespace
}  // namespace stopline
