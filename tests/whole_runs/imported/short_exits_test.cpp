// Junctions J and K in an imported network are close: the edge between them has room for one vehicle. If the vehicle on
// this edge may have to stop at K, the keep-clear rule must hold the next vehicle before J. Each case runs in both
// fidelities.
#include <gtest/gtest.h>

#include <string>

#include "base/containers/index.h"
#include "base/speed_thresholds.h"
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

// Returns SUMO's file of a street from `w` over junctions J, K and M. The edge `s` between J and K is 10 m long, the
// edge `e` between K and M 30 m. The street from `a` to `b` crosses at J and yields there. The street from `c` to `d`
// crosses at K and has priority there. M has a signal with constant green, so that the import keeps `e`.
std::string three_junctions_net() {
    return R"(<net version="1.20">
<edge id=":J_0" function="internal"><lane id=":J_0_0" index="0" speed="13.89" length="10" shape="0,-5 0,5"/></edge>
<edge id=":J_1" function="internal"><lane id=":J_1_0" index="0" speed="13.89" length="10" shape="-5,0 5,0"/></edge>
<edge id=":K_0" function="internal"><lane id=":K_0_0" index="0" speed="13.89" length="10" shape="20,-5 20,5"/></edge>
<edge id=":K_1" function="internal"><lane id=":K_1_0" index="0" speed="13.89" length="10" shape="15,0 25,0"/></edge>
<edge id=":M_0" function="internal"><lane id=":M_0_0" index="0" speed="13.89" length="10" shape="55,0 65,0"/></edge>
<edge id="w" from="W" to="J"><lane id="w_0" index="0" speed="13.89" length="200" shape="-205,0 -5,0"/></edge>
<edge id="s" from="J" to="K"><lane id="s_0" index="0" speed="13.89" length="10" shape="5,0 15,0"/></edge>
<edge id="e" from="K" to="M"><lane id="e_0" index="0" speed="13.89" length="30" shape="25,0 55,0"/></edge>
<edge id="f" from="M" to="F"><lane id="f_0" index="0" speed="13.89" length="200" shape="65,0 265,0"/></edge>
<edge id="a" from="A" to="J"><lane id="a_0" index="0" speed="13.89" length="200" shape="0,-205 0,-5"/></edge>
<edge id="b" from="J" to="B"><lane id="b_0" index="0" speed="13.89" length="200" shape="0,5 0,205"/></edge>
<edge id="c" from="C" to="K"><lane id="c_0" index="0" speed="13.89" length="200" shape="20,-205 20,-5"/></edge>
<edge id="d" from="K" to="D"><lane id="d_0" index="0" speed="13.89" length="200" shape="20,5 20,205"/></edge>
<tlLogic id="M" type="static" programID="0" offset="0"><phase duration="30" state="G"/><phase duration="30" state="G"/>
</tlLogic>
<junction id="J" type="priority" x="0" y="0" incLanes="a_0 w_0" intLanes=":J_0_0 :J_1_0" shape="0,0 1,1">
<request index="0" response="10" foes="10" cont="0"/><request index="1" response="00" foes="01" cont="0"/></junction>
<junction id="K" type="priority" x="20" y="0" incLanes="c_0 s_0" intLanes=":K_0_0 :K_1_0" shape="0,0 1,1">
<request index="0" response="00" foes="10" cont="0"/><request index="1" response="01" foes="01" cont="0"/></junction>
<junction id="M" type="traffic_light" x="60" y="0" incLanes="e_0" intLanes=":M_0_0" shape="0,0 1,1">
<request index="0" response="0" foes="0" cont="0"/></junction>
<connection from="a" to="b" fromLane="0" toLane="0" via=":J_0_0" dir="s" state="m"/>
<connection from="w" to="s" fromLane="0" toLane="0" via=":J_1_0" dir="s" state="M"/>
<connection from="c" to="d" fromLane="0" toLane="0" via=":K_0_0" dir="s" state="M"/>
<connection from="s" to="e" fromLane="0" toLane="0" via=":K_1_0" dir="s" state="m"/>
<connection from="e" to="f" fromLane="0" toLane="0" via=":M_0_0" tl="M" linkIndex="0" dir="s" state="O"/>
<connection from=":J_0" to="b" fromLane="0" toLane="0" dir="s" state="M"/>
<connection from=":J_1" to="s" fromLane="0" toLane="0" dir="s" state="M"/>
<connection from=":K_0" to="d" fromLane="0" toLane="0" dir="s" state="M"/>
<connection from=":K_1" to="e" fromLane="0" toLane="0" dir="s" state="M"/>
<connection from=":M_0" to="f" fromLane="0" toLane="0" dir="s" state="M"/>
)" + dead_ends("WABCDF") +
           "</net>\n";
}

// Returns three_junctions_net() with a signal at K: green for `c`, then green for `s`.
std::string signal_beyond_net() { return with_signal_at_k(three_junctions_net()); }

// Results of one run.
struct Observation {
    bool has_violation = false;
    int exited = 0;
    double held_s = 0.0;           // time for which the keep-clear rule holds a vehicle on `w`
    double crawling_in_j_s = 0.0;  // time for which a vehicle from `w` is slower than 1 m/s inside J
};

class ShortExits : public ::testing::TestWithParam<const char*> {
protected:
    static Observation observe(const std::string& net, const std::string& flows, const std::string& population) {
        constexpr double kDuration_s = 900.0;
        const SumoFiles files;
        files.write("my.net.xml", net);
        files.write("my.rou.xml", "<routes>\n<vType id=\"x\" length=\"5\"/>\n" + flows + "</routes>\n");
        const std::string text = std::string("fidelity: ") + GetParam() +
                                 "\nduration: 900 s\nnetwork: {kind: sumo, net: ./my.net.xml, routes: [./my.rou.xml]}\n"
                                 "populations: [" +
                                 population + "]\nmeasure: {window: 60 s}\n";
        const Model model = build_model(parse_scenario(text, "my.yaml", {}, files.folder()), 0);
        Simulation simulation(model);
        Observation result;
        const int approach = lane_named(model, "w_0");
        const int connection = lane_named(model, ":J_1_0");
        while (simulation.time_s() < kDuration_s) {
            simulation.step();
            const StopLines& stop_lines = simulation.state().stop_lines;
            result.held_s += stop_lines.lines[at(approach)].keep_clear_vehicle >= 0 ? model.step_s : 0.0;
            result.crawling_in_j_s += has_crawling_vehicle(simulation.state(), connection) ? model.step_s : 0.0;
        }
        result.has_violation = !simulation.state().records.violations.none();
        result.exited = static_cast<int>(simulation.state().records.exited);
        return result;
    }

private:
    static bool has_crawling_vehicle(const State& state, int lane) {
        const LaneBlock& block = state.blocks[at(lane)];
        for (int slot = block.first; slot < block.past_last(); ++slot) {
            if (state.vehicles.speed_mps[at(slot)] < kCrawlingSpeed_mps) return true;
        }
        return false;
    }
};

INSTANTIATE_TEST_SUITE_P(BothFidelities, ShortExits, ::testing::Values("meso", "full"),
                         [](const auto& test) { return std::string(test.param); });

// Vehicles from w often stop on s, because they yield at K.
TEST_P(ShortExits, VehicleWaitsBeforeTheJunctionUntilTheVehicleAheadHasLeftTheExit) {
    for (const std::string population : {"CTG-Ref", "CDG"}) {
        const Observation run =
            observe(three_junctions_net(), flow("w", "f", 400, 900) + flow("c", "d", 700, 900), population);
        EXPECT_GT(run.held_s, 100.0) << population;
        EXPECT_EQ(run.crawling_in_j_s, 0.0) << population;
        EXPECT_FALSE(run.has_violation) << population;
        EXPECT_GT(run.exited, 150) << population;
    }
}

// Vehicles from w stop on s while K is red. At the start of yellow a second vehicle can be inside J, and stop there for
// a moment.
TEST_P(ShortExits, VehicleWaitsBeforeTheJunctionWhileTheLightAtTheEndOfTheExitIsRed) {
    const Observation run =
        observe(signal_beyond_net(), flow("w", "f", 1600, 900) + flow("c", "d", 300, 900), "CTG-Ref");
    EXPECT_GT(run.held_s, 100.0);
    EXPECT_LT(run.crawling_in_j_s, 2.0);
    EXPECT_FALSE(run.has_violation);
    EXPECT_GT(run.exited, 150);
}

}  // namespace
}  // namespace stopline
