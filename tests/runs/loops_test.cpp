// Tests of the induction loops of a scenario (measure.loops): all kinds of networks record the vehicles that pass.
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "runs/network/network_run.h"
#include "scenario/build_model.h"
#include "scenario/kinds/network_kind.h"
#include "scenario/load_scenario.h"
#include "sim/step/simulation.h"

namespace stopline {
namespace {

using Times = std::map<int, double>;  // [vehicle] time of its crossing

// Returns the crossings of each loop, and those of the stop line of the same lane under the name "line".
std::map<std::string, Times> crossings_of(const Model& model, const std::vector<Crossing>& crossings) {
    std::map<std::string, Times> times;
    int lane = -1;
    for (const Detector& detector : model.detectors) {
        if (detector.loop >= 0) lane = detector.lane;
    }
    for (const Crossing& crossing : crossings) {
        const Detector& detector = model.detectors[static_cast<std::size_t>(crossing.detector)];
        if (detector.loop >= 0) {
            const std::string& name = model.loop_names[static_cast<std::size_t>(detector.loop)];
            EXPECT_TRUE(times[name].insert({crossing.vehicle, crossing.time_s}).second) << "counted twice";
        } else if (detector.kind == Detector::Kind::stop_line && detector.lane == lane) {
            times["line"].insert({crossing.vehicle, crossing.time_s});
        }
    }
    return times;
}

struct Network {
    const char* name;
    const char* file;  // in scenarios/
    const char* lane;
    std::vector<std::string> settings;
};

class Loops : public testing::TestWithParam<Network> {};
INSTANTIATE_TEST_SUITE_P(
    EveryKind, Loops,
    testing::Values(Network{"light", "single_light.yaml", "approach_0", {"demand.vehicles=20"}},
                    Network{"intersection", "intersection.yaml", "west_in_0", {"fidelity=meso"}},
                    Network{"grid", "grid.yaml", "c0r0_west_in_0", {"duration=200 s", "measure.window=100 s"}},
                    Network{"streets",
                            "berlin.yaml",
                            "koenigin_elisabeth_str_west_in_1",
                            {"duration=200 s", "measure.window=100 s", "fidelity=meso"}}),
    [](const testing::TestParamInfo<Network>& network) { return std::string(network.param.name); });

TEST_P(Loops, RecordEachVehicleBeforeItsStopLine) {
    const auto loop = [](const std::string& name, const std::string& position) {
        return "{name: " + name + ", lane: " + GetParam().lane + ", position: " + position + "}";
    };
    std::vector<std::string> settings = GetParam().settings;
    settings.push_back("measure.loops=[" + loop("far", "-20 m") + ", " + loop("near", "-1 m") + "]");
    const Scenario scenario = load_scenario(std::string(STOPLINE_SOURCE_DIR "/scenarios/") + GetParam().file, settings);
    Model model =
        network_kind(scenario.network).has_measured_area ? network_model(scenario, 0) : build_model(scenario, 0);
    model.records_detectors = true;
    Simulation simulation(model);
    simulation.run_until(330.0);
    const auto times = crossings_of(model, simulation.state().records.crossings);
    ASSERT_TRUE(times.contains("far") && times.contains("near") && times.contains("line"));
    EXPECT_GE(times.at("line").size(), 5U);
    int compared = 0;
    for (const auto& [vehicle, time_s] : times.at("line")) {
        if (!times.at("near").contains(vehicle)) continue;  // it changed lanes, or started beyond the loop
        EXPECT_LT(times.at("near").at(vehicle), time_s) << "vehicle " << vehicle;
        ++compared;
        if (!times.at("far").contains(vehicle)) continue;
        EXPECT_LT(times.at("far").at(vehicle), times.at("near").at(vehicle)) << "vehicle " << vehicle;
    }
    EXPECT_GE(compared, 4);
}

}  // namespace
}  // namespace stopline
