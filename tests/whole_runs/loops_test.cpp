// Tests that induction loops count each vehicle once, also vehicles that change lanes at a loop.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "runs/network/network_run.h"
#include "scenario/load_scenario.h"
#include "support/sumo_files.h"

namespace stopline {
namespace {

using testing::SumoFiles;

constexpr double kSpacing_m = 5.0;  // between cross-sections
constexpr double kFirst_m = 10.0;   // first cross-section; vehicles enter upstream of it, with their fronts at 5 m
constexpr double kLast_m = 185.0;

// Returns induction loops on both lanes at each cross-section. The id of a loop consists of its position and its lane.
std::string loops_everywhere() {
    std::string text = "<additional>\n";
    for (double position_m = kFirst_m; position_m <= kLast_m; position_m += kSpacing_m) {
        for (const int lane : {0, 1}) {
            text += "<e1Detector id=\"" + std::to_string(position_m) + "_" + std::to_string(lane) + "\" lane=\"w_in_" +
                    std::to_string(lane) + "\" pos=\"" + std::to_string(position_m) + "\" period=\"60\" file=\"x\"/>\n";
        }
    }
    return text + "</additional>";
}

// Each vehicle enters on a random lane. Left-turning vehicles must change to the left lane. Some vehicles enter slowly,
// so that others overtake them.
constexpr const char* kFlows = R"(<routes>
<flow id="s" begin="0" end="100" period="2.3" from="w_in" to="e_out" departLane="random" departSpeed="random"/>
<flow id="l" begin="0" end="100" period="3.1" from="w_in" to="n_out" departLane="random" departSpeed="max"/>
</routes>)";

class Loops : public ::testing::TestWithParam<const char*> {};

TEST_P(Loops, CountLaneChangersOnce) {
    const SumoFiles files;
    files.write("my.net.xml", testing::crossing_net());
    files.write("my.rou.xml", kFlows);
    files.write("my.add.xml", loops_everywhere());
    const Scenario scenario = parse_scenario(
        GetParam() + std::string("duration: 200 s\nnetwork: {kind: sumo, net: ./my.net.xml, routes: [./my.rou.xml], "
                                 "additional: [./my.add.xml]}\npopulations: [CTG-Ref]\nmeasure: {window: 100 s}\n"),
        "my.yaml", {}, files.folder());
    Model model = network_model(scenario, 0);
    model.records_all = true;  // keeps lane changes and passages
    model.records_detectors = true;
    Simulation simulation(model);
    simulation.run_until(200.0);
    const RunRecords& records = simulation.state().records;

    std::set<std::pair<int, double>> seen;  // vehicle and cross-section
    std::map<double, int> count;            // [cross-section] vehicles
    for (const Crossing& crossing : records.crossings) {
        const Detector& detector = model.detectors[static_cast<std::size_t>(crossing.detector)];
        if (detector.loop < 0) continue;
        EXPECT_TRUE(seen.insert({crossing.vehicle, detector.position_m}).second)
            << "vehicle " << crossing.vehicle << " is counted twice at " << detector.position_m << " m";
        ++count[detector.position_m];
    }
    // All vehicles enter at the start of the lane and leave the network before the end of the run.
    EXPECT_GT(records.entered, 60);
    EXPECT_EQ(records.exited, records.entered);
    ASSERT_EQ(count.size(), static_cast<std::size_t>((kLast_m - kFirst_m) / kSpacing_m) + 1);
    for (const auto& [position_m, vehicles] : count) {
        EXPECT_EQ(vehicles, records.entered) << position_m << " m";
    }
    // The run must contain the situation to be tested: some vehicles change lanes within 1.4 m of a loop.
    int at_loop = 0;
    for (const LaneChange& change : records.lane_changes) {
        const double beyond_m = std::fmod(change.position_m, kSpacing_m);
        if (beyond_m < 1.4 || beyond_m > kSpacing_m - 1.4) ++at_loop;
    }
    EXPECT_GT(at_loop, 5) << records.lane_changes.size();
}

INSTANTIATE_TEST_SUITE_P(BothFidelities, Loops, ::testing::Values("fidelity: meso\n", "fidelity: full\nstep: 10 ms\n"),
                         [](const auto& test) { return test.index == 0 ? "Meso" : "Full"; });

}  // namespace
}  // namespace stopline
