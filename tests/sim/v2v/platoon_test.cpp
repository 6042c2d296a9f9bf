// Platoons: who leads, where they split, how long they are, and the messages of the platoon leader.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "support/track.h"

namespace stopline {
namespace {

using namespace testing_support;

constexpr double kLimit_mps = 50.0 / 3.6;
constexpr double kPi = 3.14159265358979;

const V2vReceiver& receiver_of(const Track& track, int lane, int k) {
    return track.state().vehicles.v2v.rest[track.slot(lane, k)];
}

TrackPlan platoon_plan(std::vector<std::string> overrides) {
    TrackPlan plan;
    plan.overrides = std::move(overrides);
    return plan;
}

Track queue(const TrackPlan& plan, int vehicles) {
    Track track(plan);
    const double spacing_m = track.model().vehicles[0].length_m + 2.95;
    for (int k = 0; k < vehicles; ++k) track.place(0, plan.length_m - 1.0 - k * spacing_m, 0.0);
    return track;
}

TEST(Platoons, VehiclesJoinAtTheTail) {
    Track track(platoon_plan({"driver.v2v.topology=predecessor_and_leader"}));
    track.place_platoon(0, 500.0, kLimit_mps, 9);
    track.run(5.0);
    for (int k = 0; k < 10; ++k) {
        EXPECT_EQ(receiver_of(track, 0, k).platoon, track.vehicle(0, 0).id);
        EXPECT_EQ(receiver_of(track, 0, k).place_in_platoon, k);
    }
}

TEST(Platoons, TheTailBehindAnotherPolicyIsAPlatoonOfItsOwn) {
    TrackPlan plan = platoon_plan({"driver.v2v.topology=predecessor_and_leader", "measure.baseline=P",
                                   "populations=[{name: P, components: [{policy: CDG, share: 50 %}, {policy: HUMAN, "
                                   "share: 50 %}]}]"});
    plan.policy = "P";
    Track track(plan);
    for (int k = 0; k < 7; ++k) track.place(0, 500.0 - 25.0 * k, kLimit_mps, k == 3 ? 1 : 0);
    track.run(90.0);
    EXPECT_EQ(receiver_of(track, 0, 2).platoon, track.vehicle(0, 0).id);
    EXPECT_EQ(receiver_of(track, 0, 4).platoon, track.vehicle(0, 4).id);
    EXPECT_EQ(receiver_of(track, 0, 6).platoon, track.vehicle(0, 4).id);
    EXPECT_EQ(receiver_of(track, 0, 6).place_in_platoon, 2);
}

TEST(Platoons, ALightSplitsAPlatoon) {
    TrackPlan plan = platoon_plan({"driver.v2v.topology=predecessor_and_leader"});
    plan.length_m = 300.0;
    plan.exit_m = 800.0;
    plan.green_s = 12.0;
    Track track = queue(plan, 20);
    while (track.time_s() < 25.0) track.step();
    ASSERT_GT(track.count(0), 3);
    ASSERT_GT(track.count(1), 3);
    EXPECT_EQ(receiver_of(track, 0, 0).place_in_platoon, 0);
    EXPECT_EQ(receiver_of(track, 0, 3).platoon, track.vehicle(0, 0).id);
    EXPECT_EQ(receiver_of(track, 1, 3).platoon, track.vehicle(1, 0).id);
}

TEST(Platoons, MiniPlatoonsKeepATimeGapAndStartTogether) {
    constexpr int kVehicles = 12;
    constexpr int kLongest = 4;
    TrackPlan plan = platoon_plan({"driver.platoon.max_vehicles=4"});
    plan.green_from_s = 3.0;
    plan.length_m = 150.0;
    plan.exit_m = 1500.0;
    Track track = queue(plan, kVehicles);
    Track unlimited = queue(
        [&] {
            TrackPlan other = plan;
            other.overrides.clear();
            return other;
        }(),
        kVehicles);
    std::vector<double> started_s(kVehicles, 0.0);
    std::vector<double> started_without_limit_s(kVehicles, 0.0);
    const auto note = [](const Track& one, std::vector<double>& times_s) {
        for (const int lane : {0, 1}) {
            for (int k = 0; k < one.count(lane); ++k) {
                double& time_s = times_s[at(one.vehicle(lane, k).id)];
                if (one.vehicle(lane, k).speed_mps > 0.0 && time_s == 0.0) time_s = one.time_s();
            }
        }
    };
    while (track.time_s() < 60.0) {
        track.step();
        unlimited.step();
        note(track, started_s);
        note(unlimited, started_without_limit_s);
    }
    for (int k = 0; k < kVehicles; ++k) EXPECT_NEAR(started_s[at(k)], started_without_limit_s[at(k)], 0.3) << k;
    ASSERT_EQ(track.count(1), kVehicles);
    for (int k = 1; k < kVehicles; ++k) {
        const VehicleView view = track.vehicle(1, k);
        EXPECT_EQ(receiver_of(track, 1, k).place_in_platoon, k % kLongest);
        const double wanted_m = 2.95 + (k % kLongest == 0 ? 0.87 * view.speed_mps : 0.0);
        EXPECT_NEAR(view.gap_m, wanted_m, 0.5) << "vehicle " << k;
    }
}

// Returns the largest gap error of each follower behind a vehicle whose speed swings.
std::vector<double> errors_behind_swing(const std::vector<std::string>& overrides, int followers) {
    TrackPlan plan = platoon_plan(overrides);
    plan.length_m = 4000.0;
    plan.limit_mps = 60.0 / 3.6;
    Track track(plan);
    constexpr double kMean_mps = 12.0;
    constexpr double kSwing_mps2 = 0.8;
    constexpr double kOmega_radps = 2.0 * kPi * 0.15;
    track.place_platoon(0, 900.0, kMean_mps, followers);
    std::vector<double> largest_m(at(followers) + 1, 0.0);
    while (track.time_s() < 120.0) {
        const double t = track.time_s();
        const double ramp = std::min(t / 20.0, 1.0);  // the swing grows from 0
        const double a = ramp * kSwing_mps2 * std::sin(kOmega_radps * t);
        const VehicleView head = track.vehicle(0, 0);
        track.drive(0, 0, head.position_m, head.speed_mps, a, a, 0.2);
        track.mutable_state().vehicles.request_mps2[track.slot(0, 0)] = static_cast<float>(a);
        track.step();
        // The first vehicle moves as prescribed.
        VehicleArrays& v = track.mutable_state().vehicles;
        v.speed_mps[track.slot(0, 0)] = head.speed_mps + 0.01 * a;
        v.position_m[track.slot(0, 0)] = head.position_m + 0.01 * (head.speed_mps + 0.005 * a);
        if (t < 60.0) continue;
        for (int k = 1; k <= followers; ++k) {
            largest_m[at(k)] = std::max(largest_m[at(k)], std::abs(track.vehicle(0, k).gap_m - 2.95));
        }
    }
    return largest_m;
}

// The law with the platoon leader is made for a constant distance. A policy with a time gap keeps its own law.
TEST(Platoons, TheLawWithThePlatoonLeaderLeavesTimeGapsAsTheyAre) {
    const auto last_position_m = [](const char* policy, const char* topology) {
        TrackPlan plan = platoon_plan({std::string("driver.v2v.topology=") + topology});
        plan.policy = policy;
        plan.exit_m = 1500.0;
        plan.green_from_s = 3.0;
        Track track = queue(plan, 10);
        track.run(20.0);
        return track.vehicle(0, track.count(0) - 1).position_m;
    };
    EXPECT_EQ(last_position_m("CTG-Ref", "predecessor_and_leader"), last_position_m("CTG-Ref", "predecessor"));
    EXPECT_NE(last_position_m("CDG", "predecessor_and_leader"), last_position_m("CDG", "predecessor"));
}

// With losses, the platoon leader's message can arrive although the own leader still stands, because it has received
// none. The vehicle must not close up to it.
TEST(Platoons, NobodyClosesUpToALeaderThatHasNotHeardOfTheStart) {
    // The gap at rest contains a reserve, emergency_gap. Such long bursts of losses use some of it, at most a half.
    const double least_m = 0.5 * CaccSettings().emergency_gap_m;
    double smallest_m = 1e3;
    std::size_t mode_changes = 0;
    for (const char* seed : {"1", "2", "3", "4", "5"}) {
        TrackPlan plan =
            platoon_plan({"driver.v2v={channel: gilbert, loss: 50 %, burst: 20, topology: "
                          "predecessor_and_leader, platoon_law: {bandwidth: 0.4 1/s}}",
                          std::string("seed=") + seed});
        plan.exit_m = 1500.0;
        plan.green_from_s = 3.0;
        Track track = queue(plan, 40);
        while (track.time_s() < 40.0) {
            track.step();
            for (int k = 1; k < track.count(0); ++k) smallest_m = std::min(smallest_m, track.vehicle(0, k).gap_m);
        }
        mode_changes += track.state().records.v2v_mode_changes.size();
    }
    EXPECT_GT(smallest_m, least_m);
    EXPECT_GT(mode_changes, 100U) << "no losses";
}

// Returns a platoon of ten vehicles in motion with V2V settings.
Track moving_platoon(const std::string& v2v) {
    TrackPlan plan = platoon_plan({"driver.v2v=" + v2v});
    plan.length_m = 2000.0;
    Track track(plan);
    track.place_platoon(0, 500.0, kLimit_mps, 9);
    return track;
}

TEST(Platoons, DrivingWithThePlatoonLeaderIsAMode) {
    constexpr int kPlatoonLeader = static_cast<int>(V2vMode::platoon_leader);
    constexpr int kLongestAge_ticks = 15;
    Track track = moving_platoon("{channel: gilbert, loss: 10 %, burst: 4, topology: predecessor_and_leader}");
    std::int64_t steps = 0;
    while (track.time_s() < 60.0) {
        track.step();
        for (int k = 1; k < track.count(0); ++k) {
            const V2vReceiver& receiver = receiver_of(track, 0, k);
            if (receiver.driving_mode != V2vMode::platoon_leader) continue;
            ++steps;
            ASSERT_LE(track.state().tick - 1 - receiver.platoon_message.sent_tick, kLongestAge_ticks);
        }
    }
    const RunRecords& records = track.state().records;
    EXPECT_EQ(records.v2v_mode_steps[kPlatoonLeader], steps);
    EXPECT_GT(steps, 10'000);
    std::vector<int> mode(10, static_cast<int>(V2vMode::messages));
    int begins = 0;
    int ends = 0;
    for (const V2vModeChange& change : records.v2v_mode_changes) {
        int& present = mode[static_cast<std::size_t>(change.vehicle - track.vehicle(0, 0).id)];
        EXPECT_EQ(change.from_mode, present);
        EXPECT_NE(change.to_mode, present);
        present = change.to_mode;
        begins += change.to_mode == kPlatoonLeader ? 1 : 0;
        ends += change.from_mode == kPlatoonLeader ? 1 : 0;
    }
    EXPECT_GT(begins, 20);
    EXPECT_GT(ends, 20);
    for (int k = 1; k < track.count(0); ++k) {
        EXPECT_EQ(static_cast<int>(receiver_of(track, 0, k).driving_mode), mode[static_cast<std::size_t>(k)]);
    }
}

TEST(Platoons, AllFollowersDriveWithThePlatoonLeaderIfNoMessageIsLost) {
    Track track = moving_platoon("{interval: 100 ms, topology: predecessor_and_leader}");
    track.run(20.0);
    for (int k = 1; k < track.count(0); ++k) {
        EXPECT_EQ(receiver_of(track, 0, k).driving_mode, V2vMode::platoon_leader);
    }
}

// A platoon of ten vehicles is 75 m long. With a range of 40 m, it splits into platoons within the range, and nearly
// all vehicles still drive with a platoon leader.
TEST(Platoons, APlatoonSplitsWhereTheRangeEnds) {
    Track track = moving_platoon("{interval: 100 ms, topology: predecessor_and_leader, range: 40 m}");
    track.run(20.0);
    int with_leader = 0;
    int platoons = 0;
    for (int k = 0; k < track.count(0); ++k) {
        const V2vReceiver& receiver = receiver_of(track, 0, k);
        EXPECT_LT(receiver.place_in_platoon, 6);
        with_leader += receiver.driving_mode == V2vMode::platoon_leader ? 1 : 0;
        platoons += receiver.place_in_platoon == 0 ? 1 : 0;
    }
    EXPECT_GE(platoons, 2);
    EXPECT_GE(with_leader, track.count(0) - platoons - 1);
}

TEST(Platoons, WithTheTopologyPredecessorNobodyDrivesWithThePlatoonLeader) {
    constexpr std::size_t kPlatoonLeader = static_cast<std::size_t>(V2vMode::platoon_leader);
    Track track = moving_platoon("{channel: gilbert, loss: 30 %, burst: 10}");
    track.run(60.0);
    const RunRecords& records = track.state().records;
    EXPECT_EQ(records.v2v_mode_steps[kPlatoonLeader], 0);
    EXPECT_GT(records.v2v_mode_changes.size(), 10U);
    for (const V2vModeChange& change : records.v2v_mode_changes) {
        EXPECT_NE(change.to_mode, static_cast<int>(kPlatoonLeader));
    }
}

TEST(Platoons, ErrorsDoNotGrowWithThePlatoonLeader) {
    constexpr int kFollowers = 42;
    for (const char* delay : {"20 ms", "50 ms", "100 ms"}) {
        const std::vector<double> errors_m = errors_behind_swing(
            {std::string("driver.cacc.v2v_delay=") + delay, "driver.v2v.topology=predecessor_and_leader"}, kFollowers);
        const double near_front_m = *std::max_element(errors_m.begin() + 1, errors_m.begin() + 6);
        const double near_tail_m = *std::max_element(errors_m.end() - 5, errors_m.end());
        EXPECT_LT(near_tail_m, 1.1 * near_front_m) << delay;
        EXPECT_GT(near_front_m, 0.01) << "no swing";
    }
}

}  // namespace
}  // namespace stopline
