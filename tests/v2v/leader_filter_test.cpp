// The estimate of the leader's acceleration from radar.
#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "v2v/leader_filter.h"

namespace stopline {
namespace {

TEST(LeaderFilter, FollowsABrakingLeaderWithinATenthOfASecond) {
    const LeaderFilter filter = make_leader_filter(0.01);
    LeaderEstimateOf<double> estimate{10.0, 0.0};
    double speed_mps = 10.0;
    for (int k = 0; k < 10; ++k) {
        speed_mps -= 0.01 * 5.0;
        update_estimate(filter, speed_mps, estimate);
    }
    EXPECT_NEAR(estimate.acceleration_mps2, -5.0, 0.5);
    EXPECT_NEAR(estimate.speed_mps, speed_mps, 0.02);
}

// Radar noise of 17 mm/s, as in the model, must not look like braking.
TEST(LeaderFilter, KeepsTheNoiseOfTheRadarSmall) {
    const LeaderFilter filter = make_leader_filter(0.01);
    LeaderEstimateOf<double> estimate{10.0, 0.0};
    double sum = 0.0;
    constexpr int kSteps = 20'000;
    for (int k = 0; k < kSteps; ++k) {
        double noise = -6.0;  // sum of twelve uniform numbers: about normal with the variance 1
        for (std::uint64_t i = 0; i < 12; ++i) noise += keyed_uniform(5, k, i);
        update_estimate(filter, 10.0 + 0.017 * noise, estimate);
        sum += estimate.acceleration_mps2 * estimate.acceleration_mps2;
    }
    EXPECT_LT(std::sqrt(sum / kSteps), 0.6);
    EXPECT_GT(std::sqrt(sum / kSteps), 0.05) << "the noise has no effect at all";
}

}  // namespace
}  // namespace stopline
