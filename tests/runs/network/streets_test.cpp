// Short runs of a street network without turns, so that each vehicle enters on a lane that serves its route.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "base/containers/index.h"
#include "base/input_error.h"
#include "runs/network/network_run.h"
#include "scenario/build_model.h"
#include "scenario/load_scenario.h"
#include "sim/step/simulation.h"

namespace stopline {
namespace {

// Returns the Berlin scenario without turns. A minor leg gets one lane for going straight on and turning right.
Scenario without_turns(const std::vector<std::string>& further_overrides) {
    std::vector<std::string> overrides{"duration=240 s"};
    const Scenario berlin = load_scenario(STOPLINE_SOURCE_DIR "/scenarios/berlin.yaml");
    for (const StreetIntersection& node : berlin.network.streets.intersections) {
        for (std::size_t k = 0; k < node.legs.size(); ++k) {
            const std::string leg = "network.streets.intersections[" + node.name + "].legs[" + std::to_string(k) + "]";
            overrides.push_back(leg + ".right=0 %");
            overrides.push_back(leg + ".left=0 %");
            const bool minor = node.legs[k].from == "south" || node.legs[k].from == "north";
            if (minor) overrides.push_back(leg + ".lanes=[{movements: straight+right}]");
        }
    }
    overrides.insert(overrides.end(), further_overrides.begin(), further_overrides.end());
    return load_scenario(STOPLINE_SOURCE_DIR "/scenarios/berlin.yaml", overrides);
}

TEST(Streets, RunWithoutViolations) {
    struct Run {
        const char* fidelity;
        const char* duration;
        int min_exited;
    };
    for (const Run& settings :
         {Run{"fidelity=meso", "duration=240 s", 500}, Run{"fidelity=full", "duration=100 s", 100}}) {
        const Scenario scenario = without_turns({settings.fidelity, settings.duration});
        constexpr std::size_t kConstantDistance = 1;
        const NetworkResult run = run_network(scenario, kConstantDistance);
        EXPECT_TRUE(run.complete);
        EXPECT_TRUE(run.violations.none()) << settings.fidelity;
        EXPECT_GT(run.exited, settings.min_exited) << settings.fidelity;
        EXPECT_EQ(run.violations.lost_vehicles, 0);
    }
}

TEST(Streets, MeasuredAreaReachesToTheOuterStopLines) {
    const Scenario scenario = without_turns({});
    const Model model = network_model(scenario, 0);
    const auto zones = [&](bool leaves) {
        return std::count_if(model.detectors.begin(), model.detectors.end(), [&](const Detector& d) {
            return d.kind == Detector::Kind::zone && d.leaves_zone == leaves;
        });
    };
    // Vehicles change onto the turn pocket in the west upstream of the area and enter the area on the pocket. So the
    // pocket needs a detector in addition to those of the entry lanes.
    EXPECT_EQ(zones(false), static_cast<std::ptrdiff_t>(model.graph.entries.size()) + 1);
    for (const Detector& d : model.detectors) {
        if (d.kind != Detector::Kind::zone) continue;
        const Lane& lane = model.graph.lanes[at(d.lane)];
        EXPECT_NEAR(d.position_m, d.leaves_zone ? 20.0 : lane.stop_line_m - 20.0, 1e-9) << lane.name;
    }
}

TEST(Streets, TrafficRulesUseTheCycleAndTheLongestGreen) {
    const Scenario scenario = without_turns({});
    const Model model = build_model(scenario, 0);
    EXPECT_EQ(model.rules.teleport_ticks, to_ticks(3 * 60.0, model.step_s));
    EXPECT_EQ(model.rules.pass_blocker_ticks, to_ticks(2 * 29.0, model.step_s));
    EXPECT_EQ(model.signals.size(), 10u);
    EXPECT_EQ(model.signals.groups(), 30);
}

TEST(Streets, ApproachesCanBeChosenByName) {
    const Scenario scenario = without_turns({"demand.approaches=[suarezstr_north]"});
    const Model model = build_model(scenario, 0);
    for (const DemandPlan::Inlet& inlet : model.demand.inlets) {
        EXPECT_EQ(inlet.vehicles > 0, model.graph.lanes[at(inlet.lane)].name == "suarezstr_north_in_0");
    }
    EXPECT_THROW(build_model(without_turns({"demand.approaches=[suarezstr_up]"}), 0), InputError);
}

}  // namespace
}  // namespace stopline
