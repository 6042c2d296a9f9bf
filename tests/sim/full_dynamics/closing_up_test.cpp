// A vehicle that arrives at the speed limit behind a leader at the speed limit must reach the gap of its policy.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "support/track.h"

namespace stopline {
namespace {

using namespace testing_support;

constexpr double kLimit_mps = 40.0 / 3.6;

class ClosingUp : public testing::TestWithParam<Pairing> {};
INSTANTIATE_TEST_SUITE_P(SlowEveryPairing, ClosingUp, testing::ValuesIn(every_automated_pairing()), as_pairing_name);
INSTANTIATE_TEST_SUITE_P(TwoPairings, ClosingUp,
                         testing::Values(Pairing{"CDG", "petrol_eu4_72kw"}, Pairing{"CTG-Ref", "electric_100kw"}),
                         as_pairing_name);

// The gap is kExcess_m too large. The follower may be faster than its leader by (catch_up_factor - 1) x limit, so it
// needs kExcess_m / ((catch_up_factor - 1) x limit). The controller then takes some seconds to remove the last metres.
TEST_P(ClosingUp, TakesTheTimeThatTheSpeedDifferenceGives) {
    constexpr double kExcess_m = 20.0;
    constexpr double kControl_s = 15.0;
    constexpr double kTolerance_m = 0.3;
    TrackPlan plan;
    plan.policy = GetParam().policy;
    plan.vehicle = GetParam().vehicle;
    plan.limit_mps = kLimit_mps;
    Track track(plan);
    const double policy_gap_m = equilibrium_gap_m(track.model().policies[0].settings, kLimit_mps);
    track.place(0, 300.0, kLimit_mps);
    track.place(0, 300.0 - track.model().vehicles[0].length_m - policy_gap_m - kExcess_m, kLimit_mps);
    const double time_s = kExcess_m / ((track.model().common_driver().cacc.catch_up_factor - 1.0) * kLimit_mps);
    track.run(0.8 * time_s);
    EXPECT_GT(track.vehicle(0, 1).gap_m, policy_gap_m + kTolerance_m) << "faster than the speed difference allows";
    track.run(0.2 * time_s + kControl_s);
    EXPECT_NEAR(track.vehicle(0, 1).gap_m, policy_gap_m, kTolerance_m);
    EXPECT_NEAR(track.vehicle(0, 0).speed_mps, kLimit_mps, 0.1) << "the leader keeps the limit";
}

// A vehicle may exceed the limit only to close up to a leader within the range of its radar.
TEST(ClosingUpRange, VehicleWithoutLeaderKeepsTheLimit) {
    TrackPlan plan;
    plan.limit_mps = kLimit_mps;
    Track track(plan);
    track.place(0, 400.0, kLimit_mps);
    track.place(0, 400.0 - track.model().common_driver().cacc.radar_range_m - 30.0, kLimit_mps);
    track.run(20.0);
    EXPECT_NEAR(track.vehicle(0, 1).speed_mps, kLimit_mps, 0.1);
}

}  // namespace
}  // namespace stopline
