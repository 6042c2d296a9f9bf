// Vehicles that drive over several short lanes in one step.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <utility>

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

// The times between the passages of both ends of a lane agree with its length. Each edge ends with a stop line, which
// every vehicle passes once.
TEST(Transfer, LaneEndsAndStopLinesArePassedInTime) {
    const Model model = short_edges_model();
    Simulation simulation(model);
    simulation.run_until(60.0);
    const RunRecords& records = simulation.state().records;
    std::map<int, Passage> last;  // [vehicle]
    int compared = 0;
    for (const Passage& passage : records.passages) {
        const auto [previous, is_first] = last.try_emplace(passage.vehicle, passage);
        if (is_first) continue;
        const Passage begin = std::exchange(previous->second, passage);
        const Lane& lane = model.graph.lanes[at(passage.from_lane)];
        const double mean_mps = 0.5 * (static_cast<double>(begin.speed_mps) + passage.speed_mps);
        if (std::abs(begin.speed_mps - passage.speed_mps) > 0.1 * mean_mps || lane.length_m > 25.0) continue;
        EXPECT_NEAR((passage.time_s - begin.time_s) * mean_mps, lane.length_m, 0.3 + 0.05 * lane.length_m) << lane.name;
        ++compared;
    }
    EXPECT_GT(compared, 50);
    std::map<std::pair<int, int>, double> line_s;  // [vehicle, lane] time at the stop line
    for (const Crossing& crossing : records.crossings) {
        const Detector& detector = model.detectors[at(crossing.detector)];
        if (detector.kind != Detector::Kind::stop_line) continue;
        EXPECT_TRUE(line_s.try_emplace({crossing.vehicle, detector.lane}, crossing.time_s).second);
    }
    for (const Passage& passage : records.passages) {
        if (passage.from_lane < 0 || passage.to_lane < 0) continue;
        const Lane& lane = model.graph.lanes[at(passage.from_lane)];
        if (lane.signal_group < 0) continue;
        const double between_s = (lane.length_m - lane.stop_line_m) / passage.speed_mps;
        EXPECT_NEAR(passage.time_s - line_s.at({passage.vehicle, passage.from_lane}), between_s, 0.02) << lane.name;
    }
}

}  // namespace
}  // namespace stopline
