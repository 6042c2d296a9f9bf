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
    "{policy: CDG-6m, share: 10 %, vehicle: articulated_lorry_35t, driver: lorry}, "
    "{policy: CTG-Ref, share: 10 %, vehicle: rigid_lorry_12t, driver: lorry}, "
    "{policy: CDG-6m, share: 5 %, vehicle: city_bus_12m, driver: bus}]";

Scenario fleet(const std::string& network, const std::string& fidelity, std::vector<std::string> overrides = {}) {
    overrides.insert(overrides.begin(),
                     {"fidelity=" + fidelity, "measure.baseline=X",
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
    std::map<int, int> class_of;     // vehicle -> component
    std::map<int, double> speed_of;  // vehicle -> speed after the previous step, m/s
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
                EXPECT_EQ(v.type_of(i), model.classes[at(policy)].vehicle);
                Highest& own = highest[at(policy)];
                own.speed_mps = std::max(own.speed_mps, v.speed_mps[i]);
                const auto [last, is_new] = speed_of.emplace(v.id[i], v.speed_mps[i]);
                const double gain_mps = v.speed_mps[i] - last->second;
                if (!is_new) own.acceleration_mps2 = std::max(own.acceleration_mps2, gain_mps / model.step_s);
                last->second = v.speed_mps[i];
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
    EXPECT_GT(highest[1].acceleration_mps2, 1.3 * kLorry_mps2);  // electric cars
}

TEST_P(MixedFleet, DrivesWithoutViolationsInAGrid) {
    const Model model =
        build_model(fleet("grid", GetParam(),
                          {"demand.left=10 %", "demand.right=10 %", "network.grid.columns=2", "network.grid.rows=1",
                           "signal.green=20 s", "duration=300 s", "measure.window=120 s"}),
                    0);
    for (const Highest& own : run(model, 300.0)) EXPECT_GT(own.vehicles, 3);
}

// Lorries with a speed limiter of 60 km/h drive on a road with a limit of 80 km/h. They stay below 60 km/h, but
// vehicles ahead of the first lorry do not.
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

// Several drivers and vehicle types in one group: the batches give the same bits as the kernels for single vehicles.
TEST_P(MixedFleet, ScalarKernelsGiveTheSameBits) {
    Model model = build_model(fleet("intersection", GetParam(), {"demand.left=15 %"}), 0);
    const auto hash_of = [&](bool scalar) {
        model.scalar_kernels = scalar;
        Simulation simulation(model);
        while (simulation.time_s() < 90.0) simulation.step();
        return simulation.state_hash();
    };
    EXPECT_EQ(hash_of(true), hash_of(false));
}

// In steady state, the mean headway of a mixed fleet is the mean length plus the mean gap, divided by the speed. A
// separate run for each policy, in which all vehicles follow this policy, gives the gaps.
TEST_P(MixedFleet, SteadyHeadwayIsThatOfLengthsAndGaps) {
    const std::vector<std::string> overrides{"network.approach.length=1000 m",
                                             "network.approach.exit_length=4000 m",
                                             "signal.green=300 s",
                                             "signal.first_green=150 s",
                                             "duration=450 s",
                                             "demand.vehicles=60",
                                             "measure.green=[]",
                                             "meso.constant_time.dawdling=0",
                                             "meso.constant_distance.dawdling=0"};
    const auto steady = [&](const std::string& populations) {
        std::vector<std::string> own = overrides;
        if (!populations.empty()) own.push_back("populations=" + populations);
        if (!populations.empty()) own.push_back("measure.baseline=X");
        const SingleLightReport report = run_single_light(fleet("single_light", GetParam(), own), {});
        EXPECT_TRUE(report.no_violations());
        EXPECT_GT(report.populations[0].steady.vehicles, 30);
        return report.populations[0].steady;
    };
    const auto gap_m = [&](const std::string& policy) {
        return steady("[{name: X, components: [{policy: " + policy + ", share: 100 %}]}]").net_gap_m;
    };
    const Scenario scenario = fleet("single_light", GetParam(), overrides);
    const SteadyFlow mixed = steady("");
    const double mean_gap_m = 0.6 * gap_m("CDG") + 0.25 * gap_m("CTG-Ref") + 0.15 * gap_m("CDG-6m");
    const double expected_s =
        (mean_vehicle_m(scenario, scenario.populations[0]) + mean_gap_m) / cruise_speed_mps(scenario);
    EXPECT_NEAR(mixed.headway_s, expected_s, 0.01 * expected_s);
}

INSTANTIATE_TEST_SUITE_P(BothFidelities, MixedFleet, testing::Values("full", "meso"),
                         [](const auto& fidelity) { return std::string(fidelity.param); });

}  // namespace
}  // namespace stopline
