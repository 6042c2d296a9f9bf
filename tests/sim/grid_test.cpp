// Vehicles on several intersections, in both modes: nobody is lost or in another's way, and at each intersection the next turn
// is drawn with its share.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/input_error.h"
#include "experiment/build_model.h"
#include "scenario/load_scenario.h"
#include "sim/simulation.h"

namespace stopline {
namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

Scenario calibration(const std::vector<std::string>& overrides) {
    return load_scenario(STOPLINE_SOURCE_DIR "/scenarios/calibration.yaml", overrides);
}

class OnGrid : public testing::TestWithParam<const char*> {};

TEST_P(OnGrid, SlowEveryVehicleOfAQueueComesThroughWithoutHarm) {
    for (const char* green : {"signal.green=5 s", "signal.green=30 s"}) {
        const Scenario scenario = calibration({std::string("fidelity=") + GetParam(), green, "signal.offset=15 s"});
        const Model model = build_model(scenario, 4);
        Simulation simulation(model);
        while (simulation.time_s() < 1000.0 && simulation.state().left < 36) simulation.step();
        EXPECT_EQ(simulation.state().entered, 36);
        EXPECT_EQ(simulation.state().left, 36);
        EXPECT_TRUE(simulation.state().violations.none());
    }
}

// Traffic from one side only, which nothing holds up for long: of all that come to the intersections behind, a fifth of each lane
// turns, in every 20 vehicles.
TEST_P(OnGrid, SlowTurnsHaveTheirShareBehindEveryIntersection) {
    constexpr int kVehicles = 300;  // a lane
    Scenario scenario =
        calibration({std::string("fidelity=") + GetParam(), "signal.green=20 s", "demand.vehicles=300"});
    scenario.demand.arms = {"c1r0_south"};
    scenario.demand.left = scenario.demand.right = 0.2;
    const Model model = build_model(scenario, 0);
    Simulation simulation(model);
    while (simulation.time_s() < 4000.0 && simulation.state().left < 2 * kVehicles) simulation.step();
    EXPECT_EQ(simulation.state().left, 2 * kVehicles);
    EXPECT_TRUE(simulation.state().violations.none());
    std::vector<int> turned(model.graph.lanes.size(), 0);
    std::vector<int> passed(model.graph.lanes.size(), 0);
    for (const Passage& passage : simulation.state().passages) {
        if (passage.to_lane < 0 || model.graph.lanes[at(passage.to_lane)].origin < 0) continue;
        const Lane& inside = model.graph.lanes[at(passage.to_lane)];
        ++passed[at(inside.origin)];
        turned[at(inside.origin)] += inside.turn != Turn::straight ? 1 : 0;
    }
    int used = 0;
    for (const int link : model.graph.links) {
        if (passed[at(link)] == 0) continue;
        ++used;
        // Of a block of 20 that is not complete, at most 4 turns are missing or ahead.
        EXPECT_NEAR(turned[at(link)], 0.2 * passed[at(link)], 4.0) << model.graph.lanes[at(link)].name;
    }
    EXPECT_EQ(used, 6);  // to the centre and, beyond it, to the north on both lanes, to the west and the east on one
}

INSTANTIATE_TEST_SUITE_P(Modes, OnGrid, testing::Values("full", "meso"));

TEST(OnGridDemand, RefusesAnArmThatIsNotThere) {
    const Scenario scenario = calibration({"demand.arms=[c0r0_south]"});
    try {
        static_cast<void>(build_model(scenario, 0));
        FAIL();
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("c1r0_south_in_0"), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace stopline
