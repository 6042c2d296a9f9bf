// A movement starves if the first vehicle of its queue is stopped for the time `measure.starvation` of the scenario,
// although no queue or vehicle ahead blocks this vehicle.
#include <gtest/gtest.h>

#include <string>

#include "runs/intersection/intersection_run.h"
#include "runs/network/network.h"
#include "scenario/load_scenario.h"
#include "scenario/scenario_text.h"
#include "support/sumo_files.h"

namespace stopline {
namespace {

// In tests/data/never_green the signal of the movement from west to east is always red.
NetworkResult never_green(const std::vector<std::string>& overrides) {
    const std::string data = STOPLINE_SOURCE_DIR "/tests/data/never_green";
    const Scenario scenario = parse_scenario("{duration: 500 s, network: {kind: sumo, net: " + data +
                                                 ".net.xml, routes: [" + data + ".rou.xml]}, populations: [CTG-Ref]}",
                                             "test.yaml", overrides);
    return run_network(scenario, 0);
}

TEST(Starvation, MovementWithoutGreenMakesTheRunUnstable) {
    for (const std::string fidelity : {"meso", "full"}) {
        const NetworkResult result = never_green({"fidelity=" + fidelity});
        ASSERT_EQ(result.delays.starvations.size(), 1U) << fidelity;
        const Starvation& starving = result.delays.starvations[0];
        EXPECT_EQ(starving.cause, DelayCause::signal);
        EXPECT_LT(starving.from_s, 60.0);
        EXPECT_GE(starving.to_s, 498.0) << "the vehicle stands until the end";
        EXPECT_EQ(result.stability, Stability::unstable);
        EXPECT_EQ(result.unstable_by, InstabilityCause::starvation);
        EXPECT_EQ(result.collapse_s, starving.from_s);
        EXPECT_GT(result.exited, 20) << "the other movement has green";
    }
}

TEST(Starvation, EndsTheSearchAtTheSetTime) {
    EXPECT_TRUE(never_green({"fidelity=meso", "measure.starvation=490 s"}).delays.starvations.empty());
    EXPECT_TRUE(never_green({"fidelity=meso", "measure.starvation=0 s"}).delays.starvations.empty());
    EXPECT_EQ(never_green({"fidelity=meso", "measure.starvation=200 s"}).delays.starvations.size(), 1U);
}

// Without a signal, the first vehicle need not be stopped for two signal cycles. Here the left-turning vehicle from w
// yields to dense traffic.
TEST(Starvation, VehicleThatYieldsWithoutSignalStarves) {
    const testing::SumoFiles files;
    files.write("my.net.xml", testing::opposing_lefts_net());
    files.write("my.rou.xml", R"(<routes><vType id="x"/>
<flow id="e" type="x" from="e" to="to_w" begin="0" end="500" departSpeed="max" period="2"/>
<trip id="w" type="x" depart="30" from="w" to="to_n"/></routes>)");
    const Scenario scenario = parse_scenario(
        "{fidelity: meso, duration: 500 s, network: {kind: sumo, net: ./my.net.xml, routes: [./my.rou.xml]}, "
        "populations: [CTG-Ref], measure: {starvation: 200 s}}",
        "my.yaml", {}, files.folder());
    const NetworkResult result = run_network(scenario, 0);
    ASSERT_EQ(result.delays.starvations.size(), 1U);
    EXPECT_EQ(result.delays.starvations[0].cause, DelayCause::yielding);
}

// A long red that belongs to the signal programme is no starvation, and neither is the red before the first green.
// After such a red, vehicles that start or yield do not count either, although they were stopped for longer than
// measure.starvation.
TEST(Starvation, LongRedsOfAWorkingSignalDoNotCount) {
    const Scenario scenario = parse_scenario(
        "{fidelity: meso, network: {kind: intersection}, signal: {first_green: 400 s, green: 350 s}, populations: [CDG], "
        "demand: {left: 20 %}, measure: {cycles: 1, warmup_cycles: 0}, duration: 0 s}",
        "test.yaml");
    const IntersectionResult result = run_intersection(scenario, 0);
    EXPECT_TRUE(result.starvations.empty());
    EXPECT_GT(result.queue_veh, 5.0) << "no queue stood";
}

// In a gridlock, the keep-clear rule holds the same vehicle at each green, and its signal holds this vehicle at each
// red. The vehicle does not starve, because vehicles ahead block its way.
TEST(Starvation, VehiclesBlockedAtEachGreenDoNotStarve) {
    const Scenario scenario =
        load_scenario(STOPLINE_SOURCE_DIR "/scenarios/grid.yaml",
                      {"network.grid.columns=3", "network.grid.rows=3", "signal.green=20 s", "rules={keep_clear: on}",
                       "seed=2", "populations=[CDG]", "duration=1500 s", "measure={area_margin: 20 m, window: 600 s}"});
    const NetworkResult result = run_network(scenario, 0);
    EXPECT_GT(result.delays.longest_stop_s, 2.0 * scenario.measure.starvation_s) << "no vehicle stood for long";
    EXPECT_TRUE(result.delays.starvations.empty());
}

}  // namespace
}  // namespace stopline
