// The starvation watch on a single lane. tests/runs/network/starvation_test.cpp tests it in whole runs.
#include <gtest/gtest.h>

#include "support/track.h"

namespace stopline {
namespace {

using testing_support::Track;
using testing_support::TrackPlan;

// Returns a lane whose signal is green for 20 s in each cycle of 40 s. A vehicle starves after 100 s.
Model lane_with_signal() {
    TrackPlan plan;
    plan.length_m = 500.0;
    plan.overrides = {"fidelity=meso", "meso=fitted"};
    Model model = build_model(testing_support::scenario_of(plan), 0);
    model.signals = {};
    model.signals.add(fixed_time_plan(
        0, {GroupProgramme({{to_ticks(20.0, model.step_s), Light::green}, {to_ticks(20.0, model.step_s), Light::red}},
                           0, true)}));
    model.rules.watch_ticks = 1;
    model.rules.starvation_ticks = to_ticks(100.0, model.step_s);
    return model;
}

// Keeps the k-th vehicle of a lane at rest at a position until the next step.
void hold(Track& track, int lane, int k, double position_m) {
    VehicleArrays& v = track.mutable_state().vehicles;
    v.speed_mps[track.slot(lane, k)] = 0.0;
    v.position_m[track.slot(lane, k)] = position_m;
}

constexpr double kFirst_m = 480.0;
constexpr double kHeld_s = 150.0;

// The first vehicle does not start. The vehicles behind it stand as long as the first vehicle, but it blocks their way.
TEST(StarvationWatch, VehiclesBehindTheFirstVehicleOfTheirLaneDoNotStarve) {
    Track track(lane_with_signal());
    const double space_m = track.model().vehicles[0].length_m + 3.0;
    const int first = track.place(0, kFirst_m, 0.0);
    track.place(0, kFirst_m - space_m, 0.0);
    track.place(0, kFirst_m - 2.0 * space_m, 0.0);
    const std::int64_t release = to_ticks(kHeld_s, track.step_s());
    while (track.state().tick < release) {
        hold(track, 0, 0, kFirst_m);
        track.step();
    }
    ASSERT_EQ(track.state().blocks[0].count, 3) << "all vehicles stand";
    track.run(60.0);
    EXPECT_EQ(track.state().present(), 0);
    ASSERT_EQ(track.state().congestion.delays.starvations.size(), 1U);
    EXPECT_EQ(track.state().congestion.delays.starvations[0].vehicle, first);
}

// The first vehicle does not start. The second one drives up to it, while the third one still stands.
TEST(StarvationWatch, VehiclesThatWaitForTheDischargeDoNotStarve) {
    Track track(lane_with_signal());
    const double second_m = kFirst_m - 60.0;
    const int first = track.place(0, kFirst_m, 0.0);
    track.place(0, second_m, 0.0);
    track.place(0, second_m - track.model().vehicles[0].length_m - 3.0, 0.0);
    const std::int64_t release = to_ticks(kHeld_s, track.step_s());
    bool third_stands_alone = false;
    while (track.state().tick < release + to_ticks(30.0, track.step_s())) {
        hold(track, 0, 0, kFirst_m);
        if (track.state().tick < release) hold(track, 0, 1, second_m);
        track.step();
        third_stands_alone =
            third_stands_alone || (track.vehicle(0, 1).speed_mps > 0.1 && track.vehicle(0, 2).speed_mps < 0.1);
    }
    ASSERT_TRUE(third_stands_alone);
    ASSERT_FALSE(track.state().congestion.delays.starvations.empty());
    for (const Starvation& starving : track.state().congestion.delays.starvations) EXPECT_EQ(starving.vehicle, first);
}

// A vehicle on the exit lane does not start. The first vehicle of the approach lane stands behind it, past the signal.
TEST(StarvationWatch, VehiclesBehindAVehicleOfTheNextLaneDoNotStarve) {
    Track track(lane_with_signal());
    const double rear_m = 1.0;
    const double exit_m = rear_m + track.model().vehicles[0].length_m;
    const int ahead = track.place(1, exit_m, 0.0);
    track.place(0, 497.0, 0.0);
    const std::int64_t release = to_ticks(kHeld_s, track.step_s());
    while (track.state().tick < release) {
        hold(track, 1, 0, exit_m);
        track.step();
    }
    ASSERT_EQ(track.state().blocks[0].count, 1);
    ASSERT_LT(track.vehicle(0, 0).speed_mps, 0.1);
    track.run(60.0);
    EXPECT_EQ(track.state().present(), 0);
    for (const Starvation& starving : track.state().congestion.delays.starvations) EXPECT_EQ(starving.vehicle, ahead);
}

}  // namespace
}  // namespace stopline
