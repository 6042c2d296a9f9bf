// A platoon leader brakes to a stop while ten vehicles follow in equilibrium at 50 km/h. No vehicle may collide or
// brake harder than its gap requires.
#include <gtest/gtest.h>

#include <cstdio>

#include "support/track.h"

namespace stopline {
namespace {

using namespace testing_support;

constexpr double kBraking_mps2[] = {2.0, 4.0, 7.0};  // the last value is the hardest braking that can be requested
constexpr double kMinGap_m[] = {0.3, 0.3, 0.1};
constexpr int kFollowers = 10;
constexpr double kSpeed_mps = 50.0 / 3.6;

// A platoon leader with prescribed motion: constant speed, then a sudden braking request. Its brake follows with a lag.
struct Leader {
    double position_m, speed_mps, acceleration_mps2, request_mps2, brake_lag_s;

    void advance(double request, double dt) {
        request_mps2 = speed_mps > 0.0 ? request : 0.0;
        acceleration_mps2 += (request_mps2 - acceleration_mps2) * (1.0 - std::exp(-dt / brake_lag_s));
        const double next_mps = std::max(0.0, speed_mps + acceleration_mps2 * dt);
        if (next_mps == 0.0) acceleration_mps2 = 0.0;
        position_m += 0.5 * (speed_mps + next_mps) * dt;
        speed_mps = next_mps;
    }
};

class BrakingPlatoon : public testing::TestWithParam<Pairing> {};
INSTANTIATE_TEST_SUITE_P(SlowEveryPairing, BrakingPlatoon, testing::ValuesIn(every_pairing()), as_pairing_name);
INSTANTIATE_TEST_SUITE_P(OnePairing, BrakingPlatoon, testing::Values(Pairing{"CDG", "petrol_eu4_72kw"}),
                         as_pairing_name);

TEST_P(BrakingPlatoon, StopsWithoutTouching) {
    TrackPlan plan;
    plan.policy = GetParam().policy;
    plan.vehicle = GetParam().vehicle;
    plan.lanes = 3;
    plan.length_m = 2000.0;
    Track track(plan);
    std::vector<Leader> leaders;
    for (int k = 0; k < 3; ++k) {
        track.place_platoon(2 * k, 1000.0, kSpeed_mps, kFollowers);
        leaders.push_back({1000.0, kSpeed_mps, 0.0, 0.0, track.model().vehicles[0].brake_lag_s});
    }
    std::vector<double> smallest_gap_m(3, 1e9);
    std::vector<std::vector<double>> hardest_mps2(3, std::vector<double>(kFollowers + 1, 0.0));
    while (track.time_s() < 60.0) {
        for (int k = 0; k < 3; ++k) {
            Leader& leader = leaders[at(k)];
            track.drive(2 * k, 0, leader.position_m, leader.speed_mps, leader.acceleration_mps2, leader.request_mps2,
                        leader.brake_lag_s);
            leader.advance(track.time_s() < 15.0 ? 0.0 : -kBraking_mps2[k], track.step_s());
        }
        track.step();
        if (HasFatalFailure()) return;
        for (int k = 0; k < 3; ++k) {
            for (int n = 1; n <= kFollowers; ++n) {
                double& hardest = hardest_mps2[at(k)][at(n)];
                hardest = std::max(hardest, -track.vehicle(2 * k, n).request_mps2);
            }
            for (int n = 2; n <= kFollowers; ++n) {
                smallest_gap_m[at(k)] = std::min(smallest_gap_m[at(k)], track.vehicle(2 * k, n).gap_m);
            }
            // The simulation has moved the platoon leader in this step as a normal vehicle. The gap of the first
            // follower must therefore be measured to the leader's prescribed position.
            const double rear_m = leaders[at(k)].position_m - track.model().vehicles[0].length_m;
            smallest_gap_m[at(k)] = std::min(smallest_gap_m[at(k)], rear_m - track.vehicle(2 * k, 1).position_m);
        }
    }
    const double standstill_gap_m = equilibrium_gap_m(track.model().policies[0].settings, 0.0);
    const double tolerance_m = is_human(GetParam().policy) ? 0.35 : 0.15;  // human drivers learn late how others brake
    for (int k = 0; k < 3; ++k) {
        EXPECT_GT(smallest_gap_m[at(k)], kMinGap_m[k]) << "braking with " << kBraking_mps2[k];
        for (int n = 1; n <= kFollowers; ++n) {
            EXPECT_LT(track.vehicle(2 * k, n).speed_mps, 0.01) << "follower " << n;
            EXPECT_LT(track.vehicle(2 * k, n).gap_m, standstill_gap_m + tolerance_m) << "follower " << n;
        }
    }
    // An automated follower with a time gap of about one second need not repeat the emergency braking of its leader.
    // Hard braking dies out within three vehicles.
    const bool has_long_gap = track.model().policies[0].meso.time_gap_s > 0.8 && !is_human(GetParam().policy);
    for (int k = 0; k < 3 && has_long_gap; ++k) {
        for (int n = 4; n <= kFollowers; ++n) {
            EXPECT_LT(hardest_mps2[at(k)][at(n)], 1.3 * track.model().common_driver().cacc.deceleration_comfort_mps2)
                << "follower " << n << " when the leader brakes with " << kBraking_mps2[k];
        }
    }
    std::printf("hardest braking of the last follower at 2, 4, 7 m/s2: %.2f %.2f %.2f m/s2; ",
                hardest_mps2[0][kFollowers], hardest_mps2[1][kFollowers], hardest_mps2[2][kFollowers]);
    std::printf("smallest gap at 2, 4, 7 m/s2: %.2f %.2f %.2f m\n", smallest_gap_m[0], smallest_gap_m[1],
                smallest_gap_m[2]);
}

// A policy without time gap asks for a gap of 2 m at any speed. Human drivers who follow so closely fall back in time
// to stop behind a leader that brakes hard.
TEST(HumanPlatoon, KeepsRoomForItsResponse) {
    constexpr double kSlow_mps = 9.0;
    TrackPlan plan;
    plan.limit_mps = 100.0 / 3.6;
    plan.policy = "P";
    plan.overrides = {"policies=[{name: P, law: human, standstill_gap: 2 m, time_gap: 0 s}]", "populations=[P]",
                      "measure.baseline=P"};
    for (const std::string vehicle : {"petrol_eu4_72kw", "articulated_lorry_35t"}) {
        plan.vehicle = vehicle;
        Track track(plan);
        const PowertrainTables& type = track.model().vehicles[0];
        Leader leader{1000.0, kSlow_mps, 0.0, 0.0, type.brake_lag_s};
        for (int k = 0; k <= kFollowers; ++k) track.place(0, 1000.0 - k * (type.length_m + 2.0), kSlow_mps);
        while (track.time_s() < 60.0) {
            track.drive(0, 0, leader.position_m, leader.speed_mps, leader.acceleration_mps2, leader.request_mps2,
                        leader.brake_lag_s);
            leader.advance(track.time_s() < 15.0 ? 0.0 : -7.0, track.step_s());
            track.step();  // checks that no two vehicles overlap
            if (HasFatalFailure()) return;
        }
        EXPECT_EQ(track.vehicle(0, kFollowers).speed_mps, 0.0);
    }
}

}  // namespace
}  // namespace stopline
