// Compares the start of a queue in the mesoscale mode with full dynamics. The platoon leader accelerates as measured in
// full dynamics. A V2V message that starts the queue is passed from vehicle to vehicle, and each follower starts when
// it receives the message. A vehicle with a time-gap policy does not pass the message on.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "calibration/leader_profile.h"
#include "support/track.h"

namespace stopline {
namespace {

using namespace testing_support;

constexpr double kGreen_s = 2.0;
constexpr double kStopLine_m = 400.0;

Track queue(const std::string& policy, int vehicles, const std::vector<std::string>& overrides) {
    TrackPlan plan;
    plan.policy = policy;
    plan.length_m = kStopLine_m;
    plan.exit_m = 1000.0;
    plan.green_from_s = kGreen_s;
    plan.overrides = overrides;
    if (!overrides.empty()) plan.step_s = 0.1;
    Track track(plan);
    track.place_platoon(0, kStopLine_m - track.model().common_driver().stop.margin_m, 0.0, vehicles - 1);
    return track;
}

// Returns the time after the start of green at which the last vehicle of the queue reaches 0.1 m/s.
double last_start_s(Track track, int vehicles) {
    EXPECT_EQ(track.count(0), vehicles);
    while (track.vehicle(0, track.count(0) - 1).speed_mps < 0.1 && track.time_s() < 60.0) track.run(track.step_s());
    return track.time_s() - kGreen_s;
}

TEST(MesoStart, TravelsThroughAConstantDistanceQueueAtTheSpeedOfV2v) {
    constexpr int kQueue = 31;
    const std::string meso = "meso=passages";
    const double alone_s = last_start_s(queue("CDG", 1, {"fidelity=meso", meso}), 1);
    const double relayed_s = last_start_s(queue("CDG", kQueue, {"fidelity=meso", meso}), kQueue) - alone_s;
    EXPECT_NEAR(relayed_s, 0.1 * (kQueue - 1) / 5.0, 0.25) << "five vehicles per step of 100 ms";
    const double unrelayed_s =
        last_start_s(queue("CDG", kQueue, {"fidelity=meso", meso, "meso.start_relay_vehicles=0"}), kQueue) - alone_s;
    EXPECT_NEAR(unrelayed_s, 0.1 * (kQueue - 1), 0.25) << "one vehicle per step";
    const double full_s = last_start_s(queue("CDG", kQueue, {}), kQueue) - last_start_s(queue("CDG", 1, {}), 1);
    EXPECT_NEAR(relayed_s, full_s, 0.5);
}

// A vehicle hears no start message of a leader that is further away than the range of the messages.
TEST(MesoStart, ALeaderBeyondTheRangeIsNotHeard) {
    constexpr int kQueue = 31;
    const auto last_s = [](const std::string& setting) {
        return last_start_s(queue("CDG", kQueue, {"fidelity=meso", "meso=passages", setting}), kQueue);
    };
    const double unheard_s = last_s("driver.v2v.range=2 m");  // less than the standstill gap
    EXPECT_DOUBLE_EQ(unheard_s, last_s("meso.start_relay_vehicles=0"));
    EXPECT_LT(last_s("driver.v2v.range=5 m"), unheard_s - 1.0);
}

// A vehicle whose policy is a time gap does not relay the V2V message that starts a queue. Each vehicle behind it
// starts only after its leader has moved.
TEST(MesoStart, RelayEndsAtAVehicleWithATimeGap) {
    constexpr int kQueue = 21;
    const double with_relay_s = last_start_s(queue("CTG-Ref", kQueue, {"fidelity=meso", "meso=passages"}), kQueue);
    const double without_relay_s = last_start_s(
        queue("CTG-Ref", kQueue, {"fidelity=meso", "meso=passages", "meso.start_relay_vehicles=0"}), kQueue);
    EXPECT_DOUBLE_EQ(with_relay_s, without_relay_s);
}

// A single vehicle starts from rest. The times after its first metre are the same as in full dynamics. The first metre
// is left out, because it depends on the fitted parameter start_delay.
TEST(MesoStart, PlatoonLeaderAcceleratesAsInFullDynamics) {
    const auto times_s = [](Track track) {
        std::vector<double> times;
        const double from_m = track.vehicle(0, 0).position_m;
        for (const double distance_m : {1.0, 10.0, 30.0, 60.0, 100.0, 150.0, 200.0}) {
            double before_m = 0.0;
            double travelled_m = 0.0;
            while (travelled_m < distance_m && track.time_s() < 60.0) {
                before_m = travelled_m;
                track.run(track.step_s());
                travelled_m = track.count(0) > 0 ? track.vehicle(0, 0).position_m - from_m
                                                 : kStopLine_m - from_m + track.vehicle(1, 0).position_m;
            }
            times.push_back(track.time_s() -
                            track.step_s() * (travelled_m - distance_m) / std::max(travelled_m - before_m, 1e-9));
        }
        return times;
    };
    const std::vector<double> full = times_s(queue("CDG", 1, {}));
    const std::vector<double> meso = times_s(queue("CDG", 1, {"fidelity=meso", "meso=passages"}));
    for (std::size_t k = 1; k < full.size(); ++k) EXPECT_NEAR(meso[k] - meso[0], full[k] - full[0], 0.15) << k;
}

TEST(AccelerationProfile, DependsOnTheVehicle) {
    MesoSettings petrol;
    measure_leader_profile(single_light("petrol_eu4_72kw", "CDG"), petrol);
    ASSERT_EQ(petrol.leader_profile_mps.size(), 48U);
    // The profile has one acceleration for each 1.25 km/h of speed, so its first 40 values cover 0 to 50 km/h.
    double time_s = 0.0;
    for (std::size_t k = 0; k < 40; ++k) time_s += 1.25 / 3.6 / petrol.leader_profile_mps2[k];
    EXPECT_GT(time_s, 12.0);
    EXPECT_LT(time_s, 16.0);
    MesoSettings electric;
    measure_leader_profile(single_light("electric_100kw", "CDG"), electric);
    EXPECT_GT(*std::min_element(electric.leader_profile_mps2.begin(), electric.leader_profile_mps2.begin() + 36), 0.6)
        << "no gear changes";
    EXPECT_LT(*std::min_element(petrol.leader_profile_mps2.begin(), petrol.leader_profile_mps2.begin() + 36), 0.6);
}

}  // namespace
}  // namespace stopline
