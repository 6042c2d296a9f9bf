// Simulates the single-light scenario with every policy and vehicle: vehicles enter, queue at their standstill gaps and
// exit. The test helper Track checks in every step that no vehicle is lost, overlaps another one or enters on red.
#include <gtest/gtest.h>

#include "support/track.h"

namespace stopline {
namespace {

using namespace testing_support;

class QueueRun : public testing::TestWithParam<Pairing> {};
INSTANTIATE_TEST_SUITE_P(SlowEveryPairing, QueueRun, testing::ValuesIn(every_pairing()), as_pairing_name);
INSTANTIATE_TEST_SUITE_P(Mix, QueueRun, testing::Values(Pairing{"MIX", "petrol_eu4_72kw"}), as_pairing_name);

TEST_P(QueueRun, HoldsTheInvariantsInEveryStep) {
    Scenario scenario = single_light(GetParam().vehicle, GetParam().policy);
    scenario.demand.vehicles = 25;
    const double more_m = 25.0 * (scenario.vehicle.length_m - 5.15);  // a queue of cars is shorter by this length
    scenario.network.approach.length_m = 320.0 + more_m;
    scenario.network.approach.exit_length_m = 300.0;
    scenario.signal.first_green_s = 100.0 + more_m / 2.0;
    scenario.signal.green_s = 20.0;
    Track track(build_model(scenario, 0));
    track.run(scenario.signal.first_green_s);
    ASSERT_EQ(track.count(0), 25) << "all vehicles wait for green";
    EXPECT_EQ(track.state().records.passages.size(), 25u) << "entries";
    EXPECT_NEAR(track.vehicle(0, 0).position_m, 320.0 + more_m - scenario.driver.stop.margin_m, 0.1);
    // The gap of a SWITCH policy shrinks with falling speed only down to its switch speed. There, vehicles whose brakes
    // respond later come nearer to their leader than this gap. Human drivers estimate the gap with errors.
    const double of_human_m = is_human(GetParam().policy) ? 0.5 : 0.2;
    const double tolerance_m = scenario.vehicle.brake_lag_s > 0.2 ? 1.0 : of_human_m;
    for (int k = 1; k < 25; ++k) {
        const GapPolicy& policy = track.model().policies[at(track.state().vehicles.policy[track.slot(0, k)])];
        EXPECT_NEAR(track.vehicle(0, k).gap_m, policy.settings.standstill_gap_m, tolerance_m) << "vehicle " << k + 1;
        EXPECT_LT(track.vehicle(0, k).speed_mps, 0.05) << "vehicle " << k + 1;
    }
    track.run(80.0);
    EXPECT_GE(track.state().records.exited, 4);
    EXPECT_EQ(track.state().records.entered, 25);
    EXPECT_EQ(track.state().records.exited + track.count(0), 25) << "vehicles that exited or left the approach";
    EXPECT_EQ(track.state().records.violations.forced_red_entries, 0);
}

// Each vehicle has three passages: entry, stop line and exit, in this order.
TEST(QueueRun, RecordsEveryPassageOnce) {
    Scenario scenario = single_light("petrol_eu4_72kw", "CDG");
    scenario.demand.vehicles = 10;
    scenario.network.approach.length_m = 200.0;
    scenario.network.approach.exit_length_m = 200.0;
    scenario.signal.first_green_s = 50.0;
    Track track(build_model(scenario, 0));
    track.run(120.0);
    std::vector<std::vector<Passage>> passages_of(10);  // [vehicle]
    double previous_s = 0.0;
    for (const Passage& passage : track.state().records.passages) {
        passages_of[at(passage.vehicle)].push_back(passage);
        EXPECT_GT(passage.time_s, previous_s - track.step_s()) << "passages are in order of time within one step";
        previous_s = passage.time_s;
    }
    for (const std::vector<Passage>& passages : passages_of) {
        ASSERT_EQ(passages.size(), 3u);
        EXPECT_EQ(passages[0].from_lane, -1);
        EXPECT_EQ(passages[0].to_lane, 0);
        EXPECT_EQ(passages[1].from_lane, 0);
        EXPECT_EQ(passages[1].to_lane, 1);
        EXPECT_EQ(passages[2].from_lane, 1);
        EXPECT_EQ(passages[2].to_lane, -1);
        EXPECT_LT(passages[0].time_s, passages[1].time_s);
        EXPECT_LT(passages[1].time_s, passages[2].time_s);
    }
}

}  // namespace
}  // namespace stopline
