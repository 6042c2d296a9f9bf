// Conformance tests of every policy with every vehicle. From every feasible state the vehicle stops before a red signal
// and behind a stopped vehicle. From far away it stops exactly at the intended position.
#include <gtest/gtest.h>

#include "base/speed_thresholds.h"
#include "support/track.h"

namespace stopline {
namespace {

using namespace testing_support;

// A state is feasible if this braking suffices after the lag of the brake and kDelay_s, which covers the jerk limit.
constexpr double kFeasible_mps2 = 6.0;
constexpr double kDelay_s = 0.15;

struct InitialState {
    double speed_mps;
    double distance_m;  // to the stop line or to the leader
    bool is_far;
};

std::vector<InitialState> feasible_states(const std::string& vehicle) {
    const double delay_s = kDelay_s + load_vehicle(vehicle).brake_lag_s;
    std::vector<InitialState> states;
    for (const double kmh : {5.0, 12.0, 22.0, 35.0, 50.0, 60.0}) {
        const double v = kmh / 3.6;
        const double stopping_m = v * v / (2.0 * kFeasible_mps2) + delay_s * v;
        for (const double factor : {1.001, 1.15, 1.5, 2.5}) states.push_back({v, factor * stopping_m, false});
        states.push_back({v, 170.0, true});
    }
    return states;
}

TrackPlan red_road(const Pairing& pairing, std::size_t lanes) {
    TrackPlan plan;
    plan.policy = pairing.policy;
    plan.vehicle = pairing.vehicle;
    plan.lanes = static_cast<int>(lanes);
    plan.length_m = 1000.0;
    plan.limit_mps = 60.0 / 3.6;
    plan.green_from_s = kForever_s;
    return plan;
}

std::string describe(const InitialState& a) {
    return "from " + std::to_string(3.6 * a.speed_mps) + " km/h, " + std::to_string(a.distance_m) + " m away";
}

class Stopping : public testing::TestWithParam<Pairing> {};
INSTANTIATE_TEST_SUITE_P(SlowEveryPairing, Stopping, testing::ValuesIn(every_pairing()), as_pairing_name);
INSTANTIATE_TEST_SUITE_P(OnePairing, Stopping, testing::Values(Pairing{"SWITCH-1", "petrol_eu4_72kw"}),
                         as_pairing_name);

TEST_P(Stopping, StopsBeforeARedSignal) {
    const std::vector<InitialState> states = feasible_states(GetParam().vehicle);
    Track track(red_road(GetParam(), states.size()));
    for (std::size_t k = 0; k < states.size(); ++k) {
        track.place(static_cast<int>(2 * k), 1000.0 - states[k].distance_m, states[k].speed_mps);
    }
    track.run(45.0);
    EXPECT_EQ(track.state().records.passages.size(), 0u) << "vehicles passed the stop line";
    EXPECT_EQ(track.state().records.violations.forced_red_entries, 0);
    const double margin_m = track.model().common_driver().stop.margin_m;
    for (std::size_t k = 0; k < states.size(); ++k) {
        ASSERT_EQ(track.count(static_cast<int>(2 * k)), 1) << describe(states[k]);
        const VehicleView car = track.vehicle(static_cast<int>(2 * k), 0);
        EXPECT_LT(car.speed_mps, kBrakeHoldSpeed_mps) << describe(states[k]);
        const double distance_m = 1000.0 - car.position_m;
        EXPECT_GT(distance_m, 0.0) << describe(states[k]);
        if (states[k].is_far) {
            EXPECT_NEAR(distance_m, margin_m, 0.1) << describe(states[k]);
        }
    }
}

// A vehicle learns of a red signal when it is closer than its comfortable stopping distance. Its hardest
// braking is at most 25 % above the constant deceleration that stops it after it has driven on for kBrakingReaction_s.
TEST_P(Stopping, BrakesEvenlyIfItLearnsOfTheStopLate) {
    constexpr double kSpeed_mps = 50.0 / 3.6;
    constexpr double kOvershoot = 1.25;  // the brake lag of up to 0.3 s shortens the braking distance
    std::vector<double> distances_m;
    for (int k = 0; k < 10; ++k) distances_m.push_back(28.0 + 4.0 * k);
    Track track(red_road(GetParam(), distances_m.size()));
    for (std::size_t k = 0; k < distances_m.size(); ++k)
        track.place(static_cast<int>(2 * k), 1000.0 - distances_m[k], kSpeed_mps);
    std::vector<double> hardest_mps2(distances_m.size());
    while (track.time_s() < 12.0) {
        track.step();
        for (std::size_t k = 0; k < distances_m.size(); ++k) {
            const double braking_mps2 = -track.vehicle(static_cast<int>(2 * k), 0).acceleration_mps2;
            hardest_mps2[k] = std::max(hardest_mps2[k], braking_mps2);
        }
    }
    const StopSettings& stop = track.model().common_driver().stop;
    bool was_late = false;
    for (std::size_t k = 0; k < distances_m.size(); ++k) {
        SCOPED_TRACE(std::to_string(distances_m[k]) + " m away");
        const double room_m = distances_m[k] - stop.margin_m - kSpeed_mps * kBrakingReaction_s;
        const double later_mps2 = kSpeed_mps * kSpeed_mps / (2.0 * room_m);
        EXPECT_LT(hardest_mps2[k], kOvershoot * std::max(later_mps2, stop.deceleration_mps2));
        EXPECT_GT(1000.0 - track.vehicle(static_cast<int>(2 * k), 0).position_m, 0.0);
        was_late = was_late || later_mps2 > 1.5 * stop.deceleration_mps2;
    }
    EXPECT_TRUE(was_late);
}

TEST_P(Stopping, StopsBehindAStoppedVehicle) {
    const std::vector<InitialState> states = feasible_states(GetParam().vehicle);
    Track track(red_road(GetParam(), states.size()));
    const double margin_m = track.model().common_driver().stop.margin_m;
    const double length_m = track.model().vehicles[0].length_m;
    for (std::size_t k = 0; k < states.size(); ++k) {
        const int lane = static_cast<int>(2 * k);
        track.place(lane, 1000.0 - margin_m, 0.0);
        track.place(lane, 1000.0 - margin_m - length_m - states[k].distance_m, states[k].speed_mps);
    }
    std::vector<double> smallest_gap_m(states.size(), 1e9);
    for (int n = 0; n < 4500; ++n) {
        track.step();
        for (std::size_t k = 0; k < states.size(); ++k) {
            smallest_gap_m[k] = std::min(smallest_gap_m[k], track.vehicle(static_cast<int>(2 * k), 1).gap_m);
        }
    }
    const double standstill_gap_m = equilibrium_gap_m(track.model().policies[0].settings, 0.0);
    for (std::size_t k = 0; k < states.size(); ++k) {
        const VehicleView car = track.vehicle(static_cast<int>(2 * k), 1);
        EXPECT_GT(smallest_gap_m[k], 0.0) << describe(states[k]);
        EXPECT_LT(car.speed_mps, kBrakeHoldSpeed_mps) << describe(states[k]);
        if (states[k].is_far) {
            EXPECT_NEAR(car.gap_m, standstill_gap_m, is_human(GetParam().policy) ? 0.35 : 0.1) << describe(states[k]);
        }
    }
}

}  // namespace
}  // namespace stopline
