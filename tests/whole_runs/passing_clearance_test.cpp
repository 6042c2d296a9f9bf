// Tests if straight vehicles pass a left turner from their own lane that waits inside the intersection. The median of
// 4 m makes room for the left turner, and the setting `passing_clearance` decides.
#include <gtest/gtest.h>

#include <string>

#include "base/containers/index.h"
#include "base/speed_thresholds.h"
#include "scenario/build_model.h"
#include "scenario/load_scenario.h"
#include "sim/step/simulation.h"

namespace stopline {
namespace {

struct Encounters {
    int waits = 0;   // left turners that stop inside the intersection
    int passes = 0;  // straight vehicles that pass beside one of them
};

int lane_named(const Model& model, const std::string& name) {
    int k = 0;
    while (model.graph.lanes.at(at(k)).name != name) ++k;
    return k;
}

// Counts the encounters on the shared left lane from the west. The oncoming traffic never ends.
Encounters encounters_with(const std::string& passing_clearance) {
    const Scenario scenario = load_scenario(
        STOPLINE_SOURCE_DIR "/scenarios/berlin.yaml",
        {"network.streets=" STOPLINE_TEST_DATA_DIR "/two_intersections.yaml",
         "network.streets.passing_clearance=" + passing_clearance, "fidelity=meso", "populations=[CTG-Ref]",
         "measure.baseline=CTG-Ref", "demand.kind=saturated", "demand.start=empty", "rules.teleport_cycles=0"});
    const Model model = build_model(scenario, 0);
    const int left = lane_named(model, "second_west_0_left");
    const int straight = lane_named(model, "second_west_0_straight");
    Simulation simulation(model);
    const State& state = simulation.state();
    Encounters counted;
    int waiting = -1;   // id of the left turner that waits
    int follower = -1;  // id of the last straight vehicle that entered its connection while this left turner waits
    while (simulation.time_s() < 1800.0) {
        simulation.step();
        const VehicleArrays& v = state.vehicles;
        const LaneBlock& turning = state.blocks[at(left)];
        const bool is_stopped = turning.count > 0 && v.speed_mps[at(turning.first)] < kStoppedSpeed_mps;
        const int id = is_stopped ? v.id[at(turning.first)] : -1;
        if (id != waiting) {
            waiting = id;
            follower = -1;
            counted.waits += id >= 0 ? 1 : 0;
            continue;
        }
        if (waiting < 0) continue;
        const LaneBlock& passing = state.blocks[at(straight)];
        if (follower >= 0 && (passing.count == 0 || v.id[at(passing.first)] != follower)) {
            ++counted.passes;
            follower = -1;
        }
        constexpr double kJustEntered_m = 4.0;
        if (passing.count > 0 && v.position_m[at(passing.first)] < kJustEntered_m) follower = v.id[at(passing.first)];
    }
    EXPECT_TRUE(state.records.violations.none());
    return counted;
}

TEST(PassingClearance, DecidesWhetherStraightVehiclesPassAWaitingLeftTurner) {
    const Encounters small_clearance = encounters_with("2 m");
    EXPECT_GE(small_clearance.waits, 10);
    EXPECT_GE(small_clearance.passes, 10);
    const Encounters large_clearance = encounters_with("3.5 m");
    EXPECT_GE(large_clearance.waits, 10);
    EXPECT_EQ(large_clearance.passes, 0);
}

}  // namespace
}  // namespace stopline
