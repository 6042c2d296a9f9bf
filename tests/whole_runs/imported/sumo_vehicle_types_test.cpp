// The driving behaviour of SUMO's vehicle types in imported networks (network.vehicles: from_routes).
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "base/containers/index.h"
#include "base/io/output.h"
#include "scenario/build_model.h"
#include "scenario/load_scenario.h"
#include "sim/step/simulation.h"
#include "support/sumo_files.h"

namespace stopline {
namespace {

using testing::refusal;
using testing::SumoFiles;

constexpr const char* kTypes = R"(
    <vType id="slow" accel="1.0" decel="3.5" maxSpeed="8" tau="1.5" minGap="3" sigma="0"/>
    <vType id="lorry" vClass="truck" length="12" sigma="0"/>
    <flow id="s" type="slow" from="ab" to="bc" begin="0" end="300" period="11"/>
    <flow id="c" from="ab" to="bc" begin="0" end="300" period="7"/>
    <flow id="l" type="lorry" from="ab" to="bc" begin="0" end="300" period="13"/>
)";

Scenario scenario_of(const SumoFiles& files, const std::string& fidelity, const std::string& types,
                     const std::string& populations = "[CTG-Ref]") {
    files.write("my.net.xml", read_file(std::filesystem::path(STOPLINE_TEST_DATA_DIR) / "three_lanes.net.xml"));
    files.write("my.rou.xml", "<routes>" + types + "</routes>");
    const std::string text = "fidelity: " + fidelity +
                             "\nduration: 300 s\n"
                             "network: {kind: sumo, net: ./my.net.xml, routes: [./my.rou.xml], vehicles: from_routes}\n"
                             "measure: {window: 300 s}\npopulations: " +
                             populations + "\n";
    return parse_scenario(text, "my.yaml", {}, files.folder());
}

TEST(SumoVehicleTypes, DefineThePoliciesOfTrips) {
    const SumoFiles files;
    const Model model = build_model(
        scenario_of(files, "meso", kTypes,
                    "[{name: X, components: [{policy: CTG-Ref, share: 50 %}, {policy: CDG, share: 50 %}]}]"),
        0);
    ASSERT_EQ(model.policies.size(), 6u);  // two components, three types
    std::vector<int> trips(model.policies.size(), 0);
    for (const int policy : model.demand.trip_policies) ++trips[at(policy)];
    for (const int count : trips) EXPECT_GT(count, 5);
    for (std::size_t k = 0; k < model.policies.size(); ++k) {
        const bool is_slow = model.vehicle_of(static_cast<int>(k)).maximum_speed_mps == 8.0;
        const bool has_time_gap = model.policies[k].settings.law == "constant_time";
        if (!is_slow) continue;
        // CDG keeps the gap of its policy.
        EXPECT_EQ(model.policies[k].settings.standstill_gap_m, has_time_gap ? 3.0 : 2.95);
        if (!has_time_gap) continue;
        EXPECT_NEAR(model.following[k].equilibrium_gap_m(8.0), 3.0 + 1.5 * 8.0, 1e-9);
        EXPECT_EQ(model.following[k].braking().deceleration_mps2, 3.5);
    }
}

class SumoVehicleTypesRun : public ::testing::TestWithParam<const char*> {};

// Each type keeps its maximum speed, its acceleration and its length.
TEST_P(SumoVehicleTypesRun, DrivesAsItsTypes) {
    const SumoFiles files;
    const Model model = build_model(scenario_of(files, GetParam(), kTypes), 0);
    Simulation simulation(model);
    std::vector<double> highest_mps(3, 0.0);
    std::vector<double> highest_mps2(3, 0.0);
    while (simulation.time_s() < 300.0) {
        simulation.step();
        const VehicleArrays& v = simulation.state().vehicles;
        for (const LaneBlock& block : simulation.state().blocks) {
            for (int slot = block.first; slot < block.past_last(); ++slot) {
                const std::size_t type = at(v.policy[at(slot)]);
                EXPECT_FLOAT_EQ(v.length_m[at(slot)], type == 2 ? 12.0F : 5.0F);
                highest_mps[type] = std::max(highest_mps[type], v.speed_mps[at(slot)]);
                highest_mps2[type] = std::max(highest_mps2[type], static_cast<double>(v.acceleration_mps2[at(slot)]));
            }
        }
    }
    EXPECT_TRUE(simulation.state().records.violations.none());
    const std::vector<double> accel_mps2{1.0, 2.6, 1.3};
    for (std::size_t type = 0; type < 3; ++type) EXPECT_LT(highest_mps2[type], 1.1 * accel_mps2[type] + 0.05) << type;
    EXPECT_LT(highest_mps[0], 8.05);
    EXPECT_GT(highest_mps[1], 12.0);
}

INSTANTIATE_TEST_SUITE_P(BothFidelities, SumoVehicleTypesRun, ::testing::Values("full", "meso"),
                         [](const auto& fidelity) { return std::string(fidelity.param); });

// Full dynamics needs standstill gaps of at least 2 m.
TEST(SumoVehicleTypes, SmallGapsAreRefusedInFullDynamics) {
    const std::string types =
        "\n<vType id=\"t\" minGap=\"1\"/><trip id=\"a\" type=\"t\" depart=\"0\" from=\"ab\" to=\"bc\"/>";
    const SumoFiles files;
    EXPECT_NO_THROW(scenario_of(files, "meso", types));
    const std::string message = refusal([&] { scenario_of(files, "full", types); });
    EXPECT_NE(message.find("my.rou.xml:2"), std::string::npos) << message;
    EXPECT_NE(message.find("minGap=\"1\" is too small: in full dynamics at least 2 m"), std::string::npos) << message;
}

TEST(SumoVehicleTypes, WrongValuesAreRefusedWithTheirLine) {
    const SumoFiles files;
    const auto load = [&](const std::string& attribute) {
        return refusal([&] {
            scenario_of(files, "meso",
                        "\n<vType id=\"t\" " + attribute +
                            "/>\n<trip id=\"a\" type=\"t\" depart=\"0\" from=\"ab\" to=\"bc\"/>\n");
        });
    };
    EXPECT_EQ(load("accel=\"0\""), "my.rou.xml:2: accel=\"0\" must be between 0.1 and 20");
    EXPECT_NE(load("tau=\"-1\"").find("tau=\"-1\" must be between 0.1 and 10"), std::string::npos)
        << load("tau=\"-1\"");
}

}  // namespace
}  // namespace stopline
