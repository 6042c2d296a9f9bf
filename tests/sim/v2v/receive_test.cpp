// The receive phase: delays, ages, and the driving modes of a platoon.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/state_hash.h"
#include "support/track.h"

namespace stopline {
namespace {

using namespace testing_support;

constexpr double kSpeed_mps = 50.0 / 3.6;

TrackPlan plan_with(std::vector<std::string> overrides, const std::string& policy = "CDG") {
    TrackPlan plan;
    plan.policy = policy;
    plan.overrides = std::move(overrides);
    return plan;
}

std::vector<std::uint64_t> hashes_of_starts(const std::vector<std::string>& overrides) {
    TrackPlan plan = plan_with(overrides);
    plan.green_from_s = 3.0;
    plan.length_m = 600.0;
    Track track(plan);
    const double spacing_m = track.model().vehicles[0].length_m + 2.95;
    for (int k = 0; k < 12; ++k) track.place(0, 599.0 - k * spacing_m, 0.0);
    std::vector<std::uint64_t> hashes;
    while (track.time_s() < 25.0) {
        track.step();
        StateHash hash;
        for (int k = 0; k < track.count(0); ++k) hash.add(track.vehicle(0, k).position_m);
        hashes.push_back(hash.value());
    }
    return hashes;
}

// A channel that sends in every step and loses nothing gives the messages that the default gives.
TEST(ReceiveMessages, AnIdealChannelInEveryStepIsTheDefault) {
    EXPECT_EQ(hashes_of_starts({}), hashes_of_starts({"driver.v2v.interval=10 ms"}));
    EXPECT_NE(hashes_of_starts({}), hashes_of_starts({"driver.v2v.interval=100 ms"}));
}

TEST(ReceiveMessages, NoChannelNeedsNoMemory) {
    Track track(plan_with({}));
    EXPECT_TRUE(track.state().vehicles.v2v.rest.empty());
    EXPECT_TRUE(track.state().vehicles.own_speed_mps.empty());
}

// Without losses, the newest message has at least the age of the delay, and at most that plus the interval and jitter.
TEST(ReceiveMessages, AgesAreThoseOfDelayIntervalAndJitter) {
    Track track(plan_with({"driver.v2v.interval=100 ms", "driver.v2v.jitter=30 ms", "driver.cacc.v2v_delay=20 ms"}));
    track.place_platoon(0, 800.0, kSpeed_mps, 8);
    track.run(1.0);
    int youngest = 1000;
    int oldest = 0;
    while (track.time_s() < 20.0) {
        track.step();
        for (int k = 1; k < 9; ++k) {
            const int age =
                static_cast<int>(track.state().tick) - 1 - track.state().vehicles.v2v.sent_tick[track.slot(0, k)];
            youngest = std::min(youngest, age);
            oldest = std::max(oldest, age);
        }
    }
    EXPECT_GE(youngest, 2);
    EXPECT_LE(youngest, 3);
    EXPECT_LE(oldest, 2 + 10 + 3);
    EXPECT_GE(oldest, 12);
}

TEST(ReceiveMessages, LossesLeadThroughAllModesAndBack) {
    Track track(plan_with({"driver.v2v={channel: gilbert, loss: 30 %, burst: 10}"}));
    track.place_platoon(0, 300.0, kSpeed_mps, 12);
    track.run(100.0);
    const RunRecords& records = track.state().records;
    std::vector<int> entered(kV2vModes, 0);
    for (const V2vModeChange& change : records.v2v_mode_changes) {
        ++entered[at(change.to_mode)];
        EXPECT_NE(change.from_mode, change.to_mode);
        if (change.to_mode > change.from_mode && change.age_s >= 0.0F) {
            EXPECT_GT(change.age_s, kLongestAge_s[at(change.to_mode - 1)]);
        }
    }
    for (std::size_t mode = 0; mode < kV2vModes; ++mode) {
        const bool has_mode = mode != static_cast<std::size_t>(V2vMode::platoon_leader);
        EXPECT_EQ(entered[mode] > 5, has_mode) << kV2vModeNames[mode];
        EXPECT_EQ(records.v2v_mode_steps[mode] > 100, has_mode) << kV2vModeNames[mode];
    }
}

TEST(ReceiveMessages, AVehicleBehindAHumanDriverUsesAcc) {
    Track track(plan_with({"driver.v2v.channel=bernoulli",
                           "populations=[{name: P, components: [{policy: CDG, share: 50 %}, {policy: HUMAN, share: "
                           "50 %}]}]",
                           "measure.baseline=P"},
                          "P"));
    track.place(0, 400.0, kSpeed_mps, 1);
    track.place(0, 370.0, kSpeed_mps, 0);
    track.place(0, 361.0, kSpeed_mps, 0);
    track.run(60.0);
    const VehicleArrays& v = track.state().vehicles;
    EXPECT_EQ(v.v2v.mode_of(static_cast<int>(track.slot(0, 1))), V2vMode::acc);
    EXPECT_LE(v.v2v.mode_of(static_cast<int>(track.slot(0, 2))), V2vMode::old_messages);
    const double speed_mps = track.vehicle(0, 1).speed_mps;
    EXPECT_NEAR(track.vehicle(0, 1).gap_m, 2.95 + 1.5 * speed_mps, 1.0);
}

// A vehicle at rest behind a leader whose messages do not arrive starts only after radar shows the leader's start.
TEST(ReceiveMessages, NobodyStartsOnAnOldMessageAndEverybodyStarts) {
    TrackPlan plan = plan_with({"driver.v2v={channel: bernoulli, loss: 99 %}"});
    plan.green_from_s = 5.0;
    plan.length_m = 600.0;
    Track track(plan);
    const double spacing_m = track.model().vehicles[0].length_m + 2.95;
    constexpr int kVehicles = 10;
    for (int k = 0; k < kVehicles; ++k) track.place(0, 599.0 - k * spacing_m, 0.0);
    std::vector<double> started_s(kVehicles, 0.0);
    while (track.time_s() < 60.0 && track.count(0) > 0) {
        track.step();
        for (int k = 0; k < track.count(0); ++k) {
            const VehicleView view = track.vehicle(0, k);
            if (view.speed_mps > 0.01 && started_s[at(view.id)] == 0.0) started_s[at(view.id)] = track.time_s();
        }
    }
    for (int k = 1; k < kVehicles; ++k) {
        EXPECT_GT(started_s[at(k)], started_s[at(k - 1)] + 0.15) << "vehicle " << k << " starts before radar shows it";
        EXPECT_LT(started_s[at(k)], started_s[at(k - 1)] + 2.5) << "vehicle " << k << " waits too long";
    }
}

}  // namespace
}  // namespace stopline
