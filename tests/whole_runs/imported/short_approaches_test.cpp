// Two close junctions in an imported network: a vehicle decides right of way at the second junction on a lane that is
// much shorter than its braking distance, and its rear may still be inside the first junction. Each case runs in both
// fidelities.
#include <gtest/gtest.h>

#include <string>

#include "base/containers/index.h"
#include "scenario/build_model.h"
#include "scenario/load_scenario.h"
#include "sim/step/simulation.h"
#include "support/close_junctions.h"
#include "support/sumo_files.h"

namespace stopline {
namespace {

using testing::dead_ends;
using testing::flow;
using testing::lane_named;
using testing::SumoFiles;
using testing::with_signal_at_k;

// Returns a street from west to east over junctions J and K. The edge `s` between them is 0.2 m long. The street from
// `a` to `b` crosses at J and yields there. The street from `c` to `d` crosses at K and has priority there. Vehicles
// from `w` may also turn left to `b`.
std::string close_junctions_net() {
    return R"(<net version="1.20">
<edge id=":J_0" function="internal"><lane id=":J_0_0" index="0" speed="13.89" length="10" shape="0,-5 0,5"/></edge>
<edge id=":J_1" function="internal"><lane id=":J_1_0" index="0" speed="13.89" length="10" shape="-5,0 5,0"/></edge>
<edge id=":J_2" function="internal">
<lane id=":J_2_0" index="0" speed="7" length="7.2" shape="-5,0 -1.5,1.5 0,5"/></edge>
<edge id=":K_0" function="internal"><lane id=":K_0_0" index="0" speed="13.89" length="10" shape="7,-5 7,5"/></edge>
<edge id=":K_1" function="internal"><lane id=":K_1_0" index="0" speed="13.89" length="10" shape="5.2,0 15.2,0"/></edge>
<edge id="w" from="W" to="J"><lane id="w_0" index="0" speed="13.89" length="200" shape="-205,0 -5,0"/></edge>
<edge id="s" from="J" to="K"><lane id="s_0" index="0" speed="13.89" length="0.2" shape="5,0 5.2,0"/></edge>
<edge id="e" from="K" to="E"><lane id="e_0" index="0" speed="13.89" length="200" shape="15.2,0 215.2,0"/></edge>
<edge id="a" from="A" to="J"><lane id="a_0" index="0" speed="13.89" length="200" shape="0,-205 0,-5"/></edge>
<edge id="b" from="J" to="B"><lane id="b_0" index="0" speed="13.89" length="200" shape="0,5 0,205"/></edge>
<edge id="c" from="C" to="K"><lane id="c_0" index="0" speed="13.89" length="200" shape="7,-205 7,-5"/></edge>
<edge id="d" from="K" to="D"><lane id="d_0" index="0" speed="13.89" length="200" shape="7,5 7,205"/></edge>
<junction id="J" type="priority" x="0" y="0" incLanes="a_0 w_0" intLanes=":J_0_0 :J_1_0 :J_2_0" shape="0,0 1,1">
<request index="0" response="110" foes="110" cont="0"/><request index="1" response="000" foes="001" cont="0"/>
<request index="2" response="000" foes="001" cont="0"/></junction>
<junction id="K" type="priority" x="10.2" y="0" incLanes="c_0 s_0" intLanes=":K_0_0 :K_1_0" shape="0,0 1,1">
<request index="0" response="00" foes="10" cont="0"/><request index="1" response="01" foes="01" cont="0"/></junction>
<connection from="a" to="b" fromLane="0" toLane="0" via=":J_0_0" dir="s" state="m"/>
<connection from="w" to="s" fromLane="0" toLane="0" via=":J_1_0" dir="s" state="M"/>
<connection from="w" to="b" fromLane="0" toLane="0" via=":J_2_0" dir="l" state="M"/>
<connection from="c" to="d" fromLane="0" toLane="0" via=":K_0_0" dir="s" state="M"/>
<connection from="s" to="e" fromLane="0" toLane="0" via=":K_1_0" dir="s" state="m"/>
<connection from=":J_0" to="b" fromLane="0" toLane="0" dir="s" state="M"/>
<connection from=":J_1" to="s" fromLane="0" toLane="0" dir="s" state="M"/>
<connection from=":J_2" to="b" fromLane="0" toLane="0" dir="l" state="M"/>
<connection from=":K_0" to="d" fromLane="0" toLane="0" dir="s" state="M"/>
<connection from=":K_1" to="e" fromLane="0" toLane="0" dir="s" state="M"/>
)" + dead_ends("WEABCD") +
           "</net>\n";
}

// Returns close_junctions_net() with a signal at K: green for `c`, then green for `s`, for 20 s each.
std::string close_signal_net() { return with_signal_at_k(close_junctions_net()); }

// Returns a street over junctions J and K. The edge `s` between them is 4.2 m long. Its right lane, which all vehicles
// reach slowly from J, leads to `c`, its left lane to `d`. J has a signal with constant green, so that the import keeps
// `s`.
std::string short_fork_net() {
    return R"(<net version="1.20">
<edge id=":J_0" function="internal"><lane id=":J_0_0" index="0" speed="13.89" length="10" shape="0,0 10,0"/></edge>
<edge id=":K_0" function="internal"><lane id=":K_0_0" index="0" speed="13.89" length="10" shape="14.2,0 24.2,-4"/></edge>
<edge id=":K_1" function="internal"><lane id=":K_1_0" index="0" speed="13.89" length="10" shape="14.2,3.2 24.2,7.2"/></edge>
<edge id="a" from="A" to="J"><lane id="a_0" index="0" speed="13.89" length="100" shape="-100,0 0,0"/></edge>
<edge id="s" from="J" to="K"><lane id="s_0" index="0" speed="1.4" length="4.2" shape="10,0 14.2,0"/>
<lane id="s_1" index="1" speed="1.4" length="4.2" shape="10,3.2 14.2,3.2"/></edge>
<edge id="c" from="K" to="C"><lane id="c_0" index="0" speed="13.89" length="100" shape="24.2,-4 124.2,-4"/></edge>
<edge id="d" from="K" to="D"><lane id="d_0" index="0" speed="13.89" length="100" shape="24.2,7.2 124.2,7.2"/></edge>
<tlLogic id="J" type="static" programID="0" offset="0"><phase duration="60" state="G"/></tlLogic>
<junction id="J" type="traffic_light" x="5" y="0" incLanes="a_0" intLanes=":J_0_0" shape="0,0 1,1">
<request index="0" response="0" foes="0" cont="0"/></junction>
<junction id="K" type="priority" x="19" y="0" incLanes="s_0 s_1" intLanes=":K_0_0 :K_1_0" shape="0,0 1,1">
<request index="0" response="00" foes="00" cont="0"/><request index="1" response="00" foes="00" cont="0"/></junction>
<connection from="a" to="s" fromLane="0" toLane="0" via=":J_0_0" tl="J" linkIndex="0" dir="s" state="O"/>
<connection from="s" to="c" fromLane="0" toLane="0" via=":K_0_0" dir="R" state="M"/>
<connection from="s" to="d" fromLane="1" toLane="0" via=":K_1_0" dir="L" state="M"/>
<connection from=":J_0" to="s" fromLane="0" toLane="0" dir="s" state="M"/>
<connection from=":K_0" to="c" fromLane="0" toLane="0" dir="R" state="M"/>
<connection from=":K_1" to="d" fromLane="0" toLane="0" dir="L" state="M"/>
)" + dead_ends("ACD") +
           "</net>\n";
}

class ShortApproaches : public ::testing::TestWithParam<const char*> {
protected:
    static constexpr double kDuration_s = 600.0;

    static Model model_of(const std::string& net, const std::string& flows, const std::string& length_m,
                          const std::string& population = "CTG-Ref") {
        const SumoFiles files;
        files.write("my.net.xml", net);
        files.write("my.rou.xml", "<routes>\n<vType id=\"x\" length=\"" + length_m + "\"/>\n" + flows + "</routes>\n");
        const std::string text = std::string("fidelity: ") + GetParam() +
                                 "\nduration: 600 s\nnetwork: {kind: sumo, net: ./my.net.xml, routes: [./my.rou.xml]}\n"
                                 "populations: [" +
                                 population + "]\nmeasure: {window: 60 s}\n";
        return build_model(parse_scenario(text, "my.yaml", {}, files.folder()), 0);
    }
};

INSTANTIATE_TEST_SUITE_P(BothFidelities, ShortApproaches, ::testing::Values("meso", "full"),
                         [](const auto& test) { return std::string(test.param); });

// The vehicles from w reach K at 50 km/h over a lane of 0.2 m and must yield there. They must be able to stop before
// K's conflict area although right of way is decided only on this lane.
TEST_P(ShortApproaches, VehicleStopsBeforeTheConflictAreaBehindAShortLane) {
    for (const std::string length_m : {"5", "16.5"}) {
        const Model model =
            model_of(close_junctions_net(), flow("w", "e", 200, 600) + flow("c", "d", 400, 600), length_m);
        Simulation simulation(model);
        simulation.run_until(kDuration_s);
        const State& state = simulation.state();
        EXPECT_TRUE(state.records.violations.none()) << length_m << " m: " << state.records.violations.conflicts;
        EXPECT_GE(state.records.exited, 85) << length_m;
    }
}

// K has a signal. The vehicles from w see it before they are on the lane of 0.2 m at its stop line.
TEST_P(ShortApproaches, VehicleStopsAtARedSignalBehindAShortLane) {
    for (const std::string population : {"CTG-Ref", "CDG"}) {
        const Model model =
            model_of(close_signal_net(), flow("w", "e", 300, 600) + flow("c", "d", 300, 600), "5", population);
        Simulation simulation(model);
        simulation.run_until(kDuration_s);
        const Violations& violations = simulation.state().records.violations;
        EXPECT_TRUE(violations.none()) << population;
        EXPECT_EQ(violations.forced_red_entries, 0) << population;
        EXPECT_GE(simulation.state().records.exited, 85) << population;
    }
}

// The edge beyond J is shorter than the vehicle, which therefore cannot change lanes there. It misses its turn, and
// does not wait for a lane change.
TEST_P(ShortApproaches, VehicleMissesItsTurnOnAnEdgeShorterThanItself) {
    const Model model = model_of(short_fork_net(), R"(<trip id="t" type="x" depart="10" from="a" to="d"/>)", "5");
    lane_named(model, "s_1");  // the import keeps the short edge
    Simulation simulation(model);
    simulation.run_until(kDuration_s);
    EXPECT_EQ(simulation.state().congestion.missed_turns, 1);
    EXPECT_EQ(simulation.state().records.exited, 1);
}

// While a lorry waits at K, its rear is still inside J. The vehicles from a must wait until it has left.
TEST_P(ShortApproaches, RearInsideThePreviousJunctionKeepsCrossingVehiclesOut) {
    const Model model = model_of(
        close_junctions_net(), flow("w", "e", 120, 600) + flow("a", "b", 300, 600) + flow("c", "d", 500, 600), "16.5");
    const int before = lane_named(model, ":J_1_0");
    const int between = lane_named(model, "s_0");
    const int after = lane_named(model, ":K_1_0");
    const int crossing = lane_named(model, ":J_0_0");
    Simulation simulation(model);
    const State& state = simulation.state();
    const auto& conflicts = state.plan.conflicts(before);
    const auto area = std::find_if(conflicts.begin(), conflicts.end(),
                                   [&](const Conflict& conflict) { return conflict.other == crossing; });
    ASSERT_NE(area, conflicts.end());
    int covered_steps = 0;  // steps in which a lorry with its front beyond J covers the area
    int shared_steps = 0;
    while (simulation.time_s() < kDuration_s) {
        simulation.step();
        const VehicleArrays& v = state.vehicles;
        const auto covers = [&](int lane, double start_m, double from_m, double to_m) {
            const LaneBlock& block = state.blocks[at(lane)];
            for (int slot = block.first; slot < block.past_last(); ++slot) {
                const double front_m = start_m + v.position_m[at(slot)];
                if (front_m > from_m && front_m - static_cast<double>(v.length_m[at(slot)]) < to_m) return true;
            }
            return false;
        };
        const double between_m = state.plan.lane(before).length_m;
        const double after_m = between_m + state.plan.lane(between).length_m;
        const bool is_covered = covers(after, after_m, area->from_m, area->to_m);
        covered_steps += is_covered ? 1 : 0;
        const bool crosses = covers(crossing, 0.0, area->other_from_m, area->other_to_m);
        shared_steps += is_covered && crosses ? 1 : 0;
    }
    EXPECT_GT(covered_steps, 0);
    EXPECT_EQ(shared_steps, 0);
    EXPECT_TRUE(state.records.violations.none());
    EXPECT_GE(state.records.exited, 130);
}

}  // namespace
}  // namespace stopline
