// Actuated signals that hear platoons (`signal.platoon_range`): greens end between platoons and cut fewer of them.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/containers/index.h"
#include "scenario/build_model.h"
#include "scenario/load_scenario.h"
#include "sim/junction/lights/announced_platoon.h"
#include "sim/step/simulation.h"

namespace stopline {
namespace {

struct Counts {
    int ends = 0;  // greens of an approach lane that ended
    int cuts = 0;  // of these: some vehicles of a platoon could stop, and others could not
    bool has_violations = false;
};

// Simulates an intersection with platoons of CDG on two lanes that never have green together. If several lanes have
// green, one of them can keep the green while the platoon of another one begins to pass.
Counts count_cuts(const std::string& fidelity, const std::string& range) {
    const Scenario scenario = load_scenario(
        STOPLINE_SOURCE_DIR "/scenarios/phases.yaml",
        {"fidelity=" + fidelity, "populations=[CDG]", "measure.baseline=CDG", "signal.controller=actuated",
         "network.intersection.lanes=[{movements: straight}]",
         "signal.phases=[{protected: [west_straight, east_straight], min_green: 5 s, green: 15 s}, "
         "{protected: [south_straight, north_straight], min_green: 5 s, green: 15 s}]",
         "signal.platoon_range=" + range, "driver.platoon.max_vehicles=4", "measure.cycles=40",
         "demand={kind: rate, approaches: [west, south], inflow: 1100 veh/h, arrivals: platooned, platoon_size: 6, "
         "platoon_headway: 1.2 s}"});
    const Model model = build_model(scenario, 0);
    Simulation simulation(model);
    Counts counts;
    std::vector<Light> before = simulation.state().signals.lights;
    while (simulation.time_s() < 5'400.0) {
        simulation.step();
        const State& state = simulation.state();
        for (int lane = 0; lane < static_cast<int>(model.graph.lanes.size()); ++lane) {
            const int group = model.graph.lanes[at(lane)].signal_group;
            if (group < 0 || before[at(group)] != Light::green || state.signals.lights[at(group)] == Light::green)
                continue;
            ++counts.ends;
            const AnnouncedPlatoon platoon = announced_platoon(model, state, lane, 100.0);
            counts.cuts += platoon.rear_tick >= 0 && !platoon.can_wait ? 1 : 0;
        }
        before = simulation.state().signals.lights;
    }
    counts.has_violations = !simulation.state().records.violations.none();
    return counts;
}

class PlatoonExtension : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Fidelities, PlatoonExtension, testing::Values("meso", "full"));

TEST_P(PlatoonExtension, CutsFewerPlatoons) {
    const Counts off = count_cuts(GetParam(), "0 m");
    const Counts on = count_cuts(GetParam(), "100 m");
    EXPECT_FALSE(off.has_violations);
    EXPECT_FALSE(on.has_violations);
    EXPECT_GT(on.ends, 100);
    EXPECT_GE(off.cuts, 3);
    EXPECT_LT(3 * on.cuts, off.cuts);
}

}  // namespace
}  // namespace stopline
