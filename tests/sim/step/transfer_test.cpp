// Vehicles that drive over several short lanes in one step.
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "base/containers/index.h"
#include "scenario/build_model.h"
#include "scenario/load_scenario.h"
#include "sim/step/simulation.h"

namespace stopline {
namespace {

// Edges of 20 m with junctions of 0.1 m between them, and a limit of 100 km/h. A step of 0.5 s is a drive of 13 m.
Model short_edges_model() {
    const std::string data = STOPLINE_SOURCE_DIR "/tests/data/short_edges";
    return build_model(parse_scenario("{fidelity: meso, duration: 60 s, populations: [CTG-Ref], meso: {step: 0.5 s}, "
                                      "network: {kind: sumo, net: " +
                                          data + ".net.xml, routes: [" + data + ".rou.xml]}}",
                                      "test.yaml"),
                       0);
}

TEST(Transfer, NoVehicleIsBeyondTheEndOfItsLane) {
    const Model model = short_edges_model();
    Simulation simulation(model);
    while (simulation.time_s() < 60.0) {
        simulation.step();
        const State& state = simulation.state();
        for (int lane = 0; lane < static_cast<int>(state.blocks.size()); ++lane) {
            const LaneBlock& block = state.blocks[at(lane)];
            for (int slot = block.first; slot < block.past_last(); ++slot) {
                ASSERT_LT(state.vehicles.position_m[at(slot)], model.graph.lanes[at(lane)].length_m)
                    << model.graph.lanes[at(lane)].name << " at " << simulation.time_s() << " s";
            }
        }
    }
    EXPECT_GT(simulation.state().records.entered, 0);
}

// Each edge ends with a stop line. A vehicle passes it once, in the step in which its front reaches it.
TEST(Transfer, StopLinesAreRecordedInTheStepOfThePassage) {
    const Model model = short_edges_model();
    Simulation simulation(model);
    simulation.run_until(60.0);
    const RunRecords& records = simulation.state().records;
    std::map<std::pair<int, int>, double> line_s;  // [vehicle, lane] time at the stop line
    for (const Crossing& crossing : records.crossings) {
        const Detector& detector = model.detectors[at(crossing.detector)];
        if (detector.kind != Detector::Kind::stop_line) continue;
        EXPECT_TRUE(line_s.try_emplace({crossing.vehicle, detector.lane}, crossing.time_s).second);
    }
    int compared = 0;
    for (const Passage& passage : records.passages) {
        const auto line = line_s.find({passage.vehicle, passage.from_lane});
        if (line == line_s.end()) continue;
        const Lane& lane = model.graph.lanes[at(passage.from_lane)];
        const double between_m = lane.length_m - lane.stop_line_m;
        EXPECT_NEAR(passage.time_s - line->second, between_m / passage.speed_mps, 0.01) << lane.name;
        ++compared;
    }
    EXPECT_GT(compared, 50);
}

}  // namespace
}  // namespace stopline
