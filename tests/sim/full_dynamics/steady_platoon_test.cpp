// At constant speed every vehicle keeps the net gap of its policy, and the headway is (length + gap) / speed.
#include <gtest/gtest.h>

#include "support/track.h"

namespace stopline {
namespace {

using namespace testing_support;

constexpr double kSpeedsKmh[] = {15.0, 29.0, 31.0, 40.0, 50.0};
constexpr int kFollowers = 8;

class SteadyPlatoon : public testing::TestWithParam<Pairing> {};
INSTANTIATE_TEST_SUITE_P(SlowEveryPairing, SteadyPlatoon, testing::ValuesIn(every_automated_pairing()),
                         as_pairing_name);
INSTANTIATE_TEST_SUITE_P(OnePairing, SteadyPlatoon, testing::Values(Pairing{"SWITCH-2", "petrol_eu4_72kw"}),
                         as_pairing_name);

// Places a platoon whose gaps are alternately too large and too small.
void place_disturbed(Track& track, int lane, double front_m, double speed_mps) {
    const double gap_m = equilibrium_gap_m(track.model().policies[0].settings, speed_mps);
    double position_m = front_m;
    for (int n = 0; n <= kFollowers; ++n) {
        track.place(lane, position_m, speed_mps);
        if (n > 0) track.make_follower(lane, n);
        position_m -= track.model().vehicles[0].length_m + gap_m * (n % 2 == 0 ? 1.25 : 0.85);
    }
}

TEST_P(SteadyPlatoon, KeepsTheGapAndHeadwayOfItsPolicy) {
    TrackPlan plan;
    plan.policy = GetParam().policy;
    plan.vehicle = GetParam().vehicle;
    plan.lanes = static_cast<int>(std::size(kSpeedsKmh));
    plan.length_m = 3000.0;
    Track track(plan);
    std::vector<double> front_m;
    for (int k = 0; k < plan.lanes; ++k) {
        place_disturbed(track, 2 * k, 500.0, kSpeedsKmh[k] / 3.6);
        front_m.push_back(500.0);
    }
    while (track.time_s() < 100.0) {
        for (int k = 0; k < plan.lanes; ++k) {
            const double v = kSpeedsKmh[k] / 3.6;
            track.drive(2 * k, 0, front_m[at(k)], v, 0.0, 0.0, 0.2);
            front_m[at(k)] += v * track.step_s();
        }
        track.step();
        if (HasFatalFailure()) return;
    }
    const double length_m = track.model().vehicles[0].length_m;
    for (int k = 0; k < plan.lanes; ++k) {
        const double v = kSpeedsKmh[k] / 3.6;
        const double gap_m = equilibrium_gap_m(track.model().policies[0].settings, v);
        for (int n = 1; n <= kFollowers; ++n) {
            const VehicleView car = track.vehicle(2 * k, n);
            EXPECT_NEAR(car.speed_mps, v, 0.01 * v) << kSpeedsKmh[k] << " km/h, follower " << n;
            EXPECT_NEAR(car.gap_m, gap_m, std::max(0.01 * gap_m, 0.05)) << kSpeedsKmh[k] << " km/h, follower " << n;
            const double headway_s = (car.gap_m + length_m) / car.speed_mps;
            EXPECT_NEAR(headway_s, (gap_m + length_m) / v, 0.01 * (gap_m + length_m) / v);
        }
    }
}

}  // namespace
}  // namespace stopline
