// The length of platoons.
#include <gtest/gtest.h>

#include "v2v/platoon_length.h"

namespace stopline {
namespace {

constexpr double kLag_s = 0.2;

TEST(PlatoonLength, FallsWithTheDelay) {
    const CaccSettings cacc;
    int before = 1000;
    for (double delay_s = 0.02; delay_s < 0.5; delay_s += 0.02) {
        const int vehicles = stable_platoon_vehicles(cacc, delay_s, kLag_s);
        EXPECT_LE(vehicles, before);
        EXPECT_GE(vehicles, 1);
        before = vehicles;
    }
    EXPECT_GT(stable_platoon_vehicles(cacc, 0.02, kLag_s), 3 * stable_platoon_vehicles(cacc, 0.15, kLag_s));
}

TEST(PlatoonLength, ReadsTheSetting) {
    const CaccSettings cacc;
    EXPECT_EQ(max_platoon_vehicles({"none"}, cacc, 0.02, kLag_s), 0);
    EXPECT_EQ(max_platoon_vehicles({"8"}, cacc, 0.02, kLag_s), 8);
    EXPECT_EQ(max_platoon_vehicles({"by_stability"}, cacc, 0.05, kLag_s), stable_platoon_vehicles(cacc, 0.05, kLag_s));
    for (const char* text : {"0", "-3", "8.5", "eight", "8x", "1001"}) {
        EXPECT_EQ(max_platoon_vehicles({text}, cacc, 0.02, kLag_s), -1) << text;
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
