// A short run on streets, each vehicle on a lane that leads where it goes: nobody is lost, hit, or in another's way.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "base/containers/index.h"
#include "base/input_error.h"
#include "scenario/build_model.h"
#include "runs/network/network_run.h"
#include "scenario/load_scenario.h"
#include "sim/step/simulation.h"

namespace stopline {
namespace {

// Berlin with all turns taken out; where only turns are allowed one may go straight on.
Scenario without_turns(const std::vector<std::string>& more) {
    std::vector<std::string> overrides{"duration=240 s"};
    const Scenario berlin = load_scenario(STOPLINE_SOURCE_DIR "/scenarios/berlin.yaml");
    for (const StreetIntersection& node : berlin.network.streets.intersections) {
        for (std::size_t a = 0; a < node.legs.size(); ++a) {
            const std::string arm = "network.streets.intersections[" + node.name + "].legs[" + std::to_string(a) + "]";
            overrides.push_back(arm + ".right=0 %");
            overrides.push_back(arm + ".left=0 %");
            const bool minor = node.legs[a].from == "south" || node.legs[a].from == "north";
            if (minor) overrides.push_back(arm + ".lanes=[{movements: straight+right}]");
        }
    }
    overrides.insert(overrides.end(), more.begin(), more.end());
    return load_scenario(STOPLINE_SOURCE_DIR "/scenarios/berlin.yaml", overrides);
}

TEST(Streets, WithoutTurnsRunWithoutViolations) {
    struct Run {
        const char* fidelity;
        const char* duration;
        int left;  // at least
    };
    for (const Run& each : {Run{"fidelity=meso", "duration=240 s", 500}, Run{"fidelity=full", "duration=100 s", 100}}) {
        const Scenario scenario = without_turns({each.fidelity, each.duration});
        constexpr std::size_t kConstantDistance = 1;
        const NetworkResult run = run_network(scenario, kConstantDistance);
        EXPECT_TRUE(run.complete);
        EXPECT_TRUE(run.violations.none()) << each.fidelity;
        EXPECT_GT(run.exited, each.left) << each.fidelity;
        EXPECT_EQ(run.violations.lost_vehicles, 0);
    }
}

TEST(Streets, AreMeasuredUpToTheirOuterStopLines) {
    const Scenario scenario = without_turns({});
    const Model model = network_model(scenario, 0);
    const auto zones = [&](bool leaves) {
        return std::count_if(model.detectors.begin(), model.detectors.end(),
                             [&](const Detector& d) { return d.kind == Detector::Kind::zone && d.leaves_zone == leaves; });
    };
    // The pocket in the west, too, is a way in: vehicles change onto it before the area begins.
    EXPECT_EQ(zones(false), static_cast<std::ptrdiff_t>(model.graph.entries.size()) + 1);
    for (const Detector& d : model.detectors) {
        if (d.kind != Detector::Kind::zone) continue;
        const Lane& lane = model.graph.lanes[at(d.lane)];
        EXPECT_NEAR(d.position_m, d.leaves_zone ? 20.0 : lane.stop_line_m - 20.0, 1e-9) << lane.name;
    }
}

TEST(Streets, HaveRulesInTheirCyclesAndGreens) {
    const Scenario scenario = without_turns({});
    const Model model = build_model(scenario, 0);
    EXPECT_EQ(model.rules.teleport_ticks, to_ticks(3 * 60.0, model.step_s));
    EXPECT_EQ(model.rules.pass_blocker_ticks, to_ticks(2 * 29.0, model.step_s));
    EXPECT_EQ(model.signals.size(), 30u);
}

TEST(Streets, ArmsCanBeChosenByName) {
    const Scenario scenario = without_turns({"demand.approaches=[suarezstr_north]"});
    const Model model = build_model(scenario, 0);
    for (const DemandPlan::Inlet& inlet : model.demand.inlets) {
        EXPECT_EQ(inlet.vehicles > 0, model.graph.lanes[at(inlet.lane)].name == "suarezstr_north_in_0");
    }
    EXPECT_THROW(build_model(without_turns({"demand.approaches=[suarezstr_up]"}), 0), InputError);
}

}  // namespace
}  // namespace stopline
