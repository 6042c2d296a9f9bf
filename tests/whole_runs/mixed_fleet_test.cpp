// Runs of mixed fleets: cars, electric cars, lorries and buses with different spacing policies, in both fidelities.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "base/containers/index.h"
#include "runs/single_light/single_light.h"
#include "scenario/build_model.h"
#include "scenario/fleets.h"
#include "scenario/load_scenario.h"
#include "sim/step/simulation.h"

namespace stopline {
namespace {

constexpr const char* kFleet =
    "[{policy: CDG, share: 35 %}, {policy: CDG, share: 25 %, vehicle: electric_100kw}, {policy: CTG-Ref, share: 15 %}, "
    "{policy: CDG, share: 10 %, vehicle: articulated_lorry_35t, driver: lorry}, "
    "{policy: CTG-Ref, share: 10 %, vehicle: rigid_lorry_12t, driver: lorry}, "
    "{policy: CDG, share: 5 %, vehicle: city_bus_12m, driver: bus}]";

Scenario fleet(const std::string& network, const std::string& fidelity, std::vector<std::string> overrides = {}) {
    overrides.insert(overrides.begin(),
                     {"fidelity=" + fidelity, "rules.keep_clear=on",
                      "populations=[{name: X, pattern: balanced, components: " + std::string(kFleet) + "}]"});
    if (fidelity == "full") overrides.push_back("step=20 ms");
    return load_scenario(std::string(STOPLINE_SOURCE_DIR "/scenarios/") + network + ".yaml", overrides);
}

// The highest values that the vehicles of one component reached.
struct Highest {
    int vehicles = 0;
    double speed_mps = 0.0;
    double acceleration_mps2 = 0.0;
};

// Runs the model and returns the highest values by component. Checks the length of every vehicle.
std::vector<Highest> run(const Model& model, double until_s) {
    Simulation simulation(model);
    std::vector<Highest> highest(model.classes.size());
    std::map<int, int> class_of;  // vehicle -> component
    while (simulation.time_s() < until_s) {
        simulation.step();
        const State& state = simulation.state();
        const VehicleArrays& v = state.vehicles;
        for (const LaneBlock& block : state.blocks) {
            for (int slot = block.first; slot < block.past_last(); ++slot) {
                const std::size_t i = at(slot);
                const int policy = v.policy[i];
                class_of.emplace(v.id[i], policy);
                EXPECT_FLOAT_EQ(v.length_m[i], static_cast<float>(model.vehicle_of(policy).length_m));
                EXPECT_EQ(v.type[i], model.classes[at(policy)].vehicle);
                Highest& own = highest[at(policy)];
                own.speed_mps = std::max(own.speed_mps, v.speed_mps[i]);
                own.acceleration_mps2 = std::max(own.acceleration_mps2, static_cast<double>(v.acceleration_mps2[i]));
            }
        }
    }
    for (const auto& [vehicle, policy] : class_of) ++highest[at(policy)].vehicles;
    EXPECT_TRUE(simulation.state().records.violations.none());
    return highest;
}

class MixedFleet : public testing::TestWithParam<const char*> {};

TEST_P(MixedFleet, DrivesWithoutViolationsAtAnIntersection) {
    const Model model = build_model(fleet("intersection", GetParam(), {"demand.left=15 %", "demand.right=30 %"}), 0);
    const std::vector<Highest> highest = run(model, 300.0);
    for (const Highest& own : highest) EXPECT_GT(own.vehicles, 3);
    constexpr double kLorry_mps2 = 1.0;  // data/drivers/lorry.yaml
    for (const std::size_t lorry : {3u, 4u}) EXPECT_LE(highest[lorry].acceleration_mps2, 1.1 * kLorry_mps2);
    EXPECT_GT(highest[1].acceleration_mps2, 1.5 * kLorry_mps2);  // electric cars
}

TEST_P(MixedFleet, DrivesWithoutViolationsInAGrid) {
    const Model model =
        build_model(fleet("grid", GetParam(),
                          {"demand.left=10 %", "demand.right=10 %", "network.grid.columns=2", "network.grid.rows=1",
                           "signal.green=20 s", "duration=300 s", "measure.window=120 s"}),
                    0);
    for (const Highest& own : run(model, 300.0)) EXPECT_GT(own.vehicles, 3);
}

// A lorry with a speed limiter of 60 km/h on a road with a limit of 80 km/h: neither the lorry nor its followers are
// faster. Vehicles ahead of the first lorry are.
TEST_P(MixedFleet, SpeedLimitersHold) {
    Scenario scenario = fleet("single_light", GetParam(),
                              {"network.approach.speed_limit=80 km/h", "network.approach.length=1000 m",
                               "network.approach.exit_length=1500 m"});
    scenario.populations[0].components[3].vehicle->maximum_speed_mps = 60.0 / 3.6;
    const Model model = build_model(scenario, 0);
    const std::vector<Highest> highest = run(model, scenario.duration_s);
    EXPECT_LE(highest[3].speed_mps, 60.5 / 3.6);
    EXPECT_GT(highest[3].speed_mps, 50.0 / 3.6);
    EXPECT_GT(highest[0].speed_mps, 65.0 / 3.6);
}

// In steady state, the mean headway is the mean length plus the mean gap, divided by the speed.
TEST_P(MixedFleet, SteadyHeadwayIsThatOfLengthsAndGaps) {
    const Scenario scenario = fleet("single_light", GetParam(),
                                    {"network.approach.length=1000 m", "network.approach.exit_length=4000 m",
                                     "signal.green=300 s", "duration=360 s", "demand.vehicles=60", "measure.green=[]"});
    const SingleLightReport report = run_single_light(scenario, {});
    ASSERT_TRUE(report.no_violations());
    const SteadyFlow& steady = report.populations[0].steady;
    EXPECT_GT(steady.vehicles, 30);
    EXPECT_NEAR(steady.deviation_percent, 0.0, 1.0);
}

INSTANTIATE_TEST_SUITE_P(BothFidelities, MixedFleet, testing::Values("full", "meso"),
                         [](const auto& fidelity) { return std::string(fidelity.param); });

}  // namespace
}  // namespace stopline
