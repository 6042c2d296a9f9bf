// Behaviour on yellow. A vehicle that can stop with the accepted deceleration stops; all others pass before red. No
// vehicle that could have stopped enters on red.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "support/track.h"

namespace stopline {
namespace {

using namespace testing_support;

constexpr double kYellowFrom_s = 8.0;
constexpr double kYellow_s = 3.0;
constexpr double kStopLine_m = 800.0;
// Tolerance of stopping_distance_m(), which ignores downshifts. While a lower gear engages, up to a third of the
// deceleration is missing until the brakes respond. The error is largest for a diesel car that shifts down twice.
constexpr double kTolerance_m = 0.2;

// Returns the distance in which a vehicle stops with the accepted deceleration. Braking starts after the brake lag and
// half of the time in which the jerk limit changes the request. The vehicle keeps accelerating until then.
double stopping_distance_m(const Model& model, const VehicleView& car) {
    const double b = model.drivers[0].tables.stop.decision_deceleration_mps2;
    const double a = std::max(car.acceleration_mps2, 0.0);
    const double request = std::max(car.request_mps2, a);
    const double delay_s =
        model.vehicles[0].brake_lag_s + 0.5 * (request + b) / model.drivers[0].tables.cacc.jerk_down_mps3;
    const double v = car.speed_mps + a * delay_s;
    return v * v / (2.0 * b) + (car.speed_mps + 0.5 * a * delay_s) * delay_s;
}

// Decelerations up to which a driver stops on yellow: the default, and maximum braking.
constexpr std::array kDecisions{"3.5 m/s2", "7 m/s2"};

std::vector<std::string> decision_deceleration(const char* deceleration) {
    return {std::string("driver={base: startup_kit, stop: {decision_deceleration: ") + deceleration + "}}"};
}

class Yellow : public testing::TestWithParam<std::string> {
protected:
    static void check_decisions(double kmh, const char* decision);
};
INSTANTIATE_TEST_SUITE_P(EveryVehicle, Yellow, testing::ValuesIn(data_names("vehicles")), as_name);

// Places one vehicle per lane at the speed limit. The vehicles are at different distances when the signal turns yellow.
void Yellow::check_decisions(double kmh, const char* decision) {
    TrackPlan plan;
    plan.overrides = decision_deceleration(decision);
    plan.vehicle = GetParam();
    plan.lanes = 40;
    plan.length_m = kStopLine_m;
    plan.limit_mps = kmh / 3.6;
    plan.green_s = kYellowFrom_s;
    Track track(plan);
    for (int k = 0; k < plan.lanes; ++k) {
        track.place(2 * k, kStopLine_m - 1.5 * k - plan.limit_mps * kYellowFrom_s, plan.limit_mps);
    }
    track.run(kYellowFrom_s);
    std::vector<bool> passed_before;
    std::vector<double> slack_m;  // distance to the line minus stopping distance; below 0: cannot stop
    for (int k = 0; k < plan.lanes; ++k) {
        passed_before.push_back(track.count(2 * k) == 0);
        if (passed_before.back()) {
            slack_m.push_back(0.0);
            continue;
        }
        const VehicleView car = track.vehicle(2 * k, 0);
        slack_m.push_back(kStopLine_m - car.position_m - stopping_distance_m(track.model(), car));
    }
    track.run(25.0);
    for (int k = 0; k < plan.lanes; ++k) {
        if (passed_before[at(k)] || std::fabs(slack_m[at(k)]) < kTolerance_m) continue;
        const bool stopped = track.count(2 * k) == 1 && track.vehicle(2 * k, 0).speed_mps < 1e-3;
        EXPECT_EQ(stopped, slack_m[at(k)] > 0.0) << kmh << " km/h, slack " << slack_m[at(k)] << " m";
    }
    EXPECT_EQ(track.state().records.violations.forced_red_entries, 0) << kmh << " km/h";
    for (const Passage& passage : track.state().records.passages) {
        if (passage.from_lane % 2 == 0) {
            EXPECT_LT(passage.time_s, kYellowFrom_s + kYellow_s);
        }
    }
}

TEST_P(Yellow, ExactlyTheVehiclesThatCanStopDoSo) {
    for (const char* const decision : kDecisions) {
        for (const double kmh : {20.0, 35.0, 50.0, 60.0}) {
            SCOPED_TRACE(decision);
            check_decisions(kmh, decision);
        }
    }
}

// Yellow splits a starting queue. The first vehicle that can stop and all vehicles behind it stop; all others pass.
class YellowQueue : public testing::TestWithParam<Pairing> {
protected:
    static void check_split(double green_s, const char* decision);
};
INSTANTIATE_TEST_SUITE_P(SlowEveryPairing, YellowQueue, testing::ValuesIn(every_pairing()), as_pairing_name);
INSTANTIATE_TEST_SUITE_P(OnePairing, YellowQueue, testing::Values(Pairing{"CDG", "petrol_eu4_72kw"}), as_pairing_name);

void YellowQueue::check_split(double green_s, const char* decision) {
    TrackPlan plan;
    plan.overrides = decision_deceleration(decision);
    plan.policy = GetParam().policy;
    plan.vehicle = GetParam().vehicle;
    plan.length_m = kStopLine_m;
    plan.green_from_s = 5.0;
    plan.green_s = green_s;
    Track track(plan);
    track.place_platoon(0, kStopLine_m - track.model().common_driver().stop.margin_m, 0.0, 35);
    track.run(5.0 + green_s);
    int expected = 0;  // vehicles on the approach that cannot stop
    double slack_m = 0.0;
    while (expected < track.count(0)) {
        const VehicleView car = track.vehicle(0, expected);
        slack_m = kStopLine_m - car.position_m - stopping_distance_m(track.model(), car);
        if (slack_m > 0.0) break;
        ++expected;
    }
    const int before = track.count(0);
    track.run(15.0);
    const int passed = before - track.count(0);
    EXPECT_TRUE(passed == expected || (passed == expected + 1 && slack_m < kTolerance_m))
        << "green " << green_s << ", slack " << slack_m << " m: " << passed << " passed, expected " << expected;
    EXPECT_EQ(track.state().records.violations.forced_red_entries, 0) << "green " << green_s;
    double last_s = 0.0;
    for (const Passage& passage : track.state().records.passages) {
        if (passage.from_lane == 0) last_s = passage.time_s;
    }
    EXPECT_LT(last_s, 5.0 + green_s + kYellow_s) << "green " << green_s;
}

TEST_P(YellowQueue, SplitsAtTheFirstVehicleThatCanStop) {
    for (const char* const decision : kDecisions) {
        for (const double green_s : {2.0, 4.0, 7.0, 11.0, 16.0, 24.0}) {
            SCOPED_TRACE(decision);
            check_split(green_s, decision);
        }
    }
}

// Without yellow some vehicles need nearly maximum braking to stop. A vehicle that shifts down meanwhile loses braking
// and overruns the stop line. Such an overrun counts as a forced red entry.
TEST(WithoutYellow, OnlyForcedRedEntriesOccur) {
    const Scenario scenario =
        load_scenario(STOPLINE_SOURCE_DIR "/scenarios/intersection.yaml",
                      {"signal.yellow=0 s", "signal.all_red=0 s", "populations=[CDG]", "measure.baseline=CDG"});
    const Model model = build_model(scenario, 0);
    Simulation simulation(model);
    simulation.run_until(180.0);
    EXPECT_EQ(simulation.state().records.violations.red_entries, 0);
    EXPECT_GT(simulation.state().records.violations.forced_red_entries, 0);
}

}  // namespace
}  // namespace stopline
