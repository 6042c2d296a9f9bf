// Populations whose components have their own vehicles and drivers: loading, names, checks, and the model.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/containers/index.h"
#include "base/input_error.h"
#include "scenario/build_model.h"
#include "scenario/fleets.h"
#include "scenario/load_scenario.h"

namespace stopline {
namespace {

Scenario with_components(const std::string& components, const std::vector<std::string>& overrides = {}) {
    return parse_scenario("demand: {vehicles: 20}\npopulations:\n- {name: X, components: [" + components + "]}\n",
                          "fleet", overrides);
}

constexpr const char* kCarsAndLorries =
    "{policy: CDG, share: 60 %}, {policy: CDG-6m, share: 10 %, vehicle: articulated_lorry_35t, driver: lorry}, "
    "{policy: CTG-Ref, share: 30 %, vehicle: {base: electric_100kw, length: 4.5 m}}";

TEST(Fleets, ComponentsHaveTheirOwnVehicleAndDriver) {
    const Scenario scenario = with_components(kCarsAndLorries);
    const std::vector<PopulationSettings::Component>& components = scenario.populations[0].components;
    EXPECT_FALSE(components[0].vehicle.has_value());
    EXPECT_EQ(vehicle_of(scenario, components[0]).name, "petrol_eu4_72kw");
    EXPECT_EQ(vehicle_of(scenario, components[1]).name, "articulated_lorry_35t");
    EXPECT_EQ(driver_of(scenario, components[1]).name, "lorry");
    EXPECT_EQ(driver_of(scenario, components[1]).cacc.acceleration_max_mps2, 1.0);
    EXPECT_EQ(vehicle_of(scenario, components[2]).length_m, 4.5);
    EXPECT_EQ(component_name(components[0]), "CDG");
    EXPECT_EQ(component_name(components[1]), "CDG-6m_articulated_lorry_35t_lorry");
    EXPECT_EQ(longest_vehicle_m(scenario), 16.5);
    EXPECT_NEAR(mean_vehicle_m(scenario, scenario.populations[0]), 0.6 * 5.15 + 0.1 * 16.5 + 0.3 * 4.5, 1e-12);
}

TEST(Fleets, ModelHasEachVehicleAndDriverOnce) {
    const Scenario scenario = with_components(
        "{policy: CDG, share: 40 %}, {policy: CTG-Ref, share: 40 %}, "
        "{policy: CDG-6m, share: 10 %, vehicle: city_bus_12m}, {policy: CTG-Ref, share: 10 %, vehicle: city_bus_12m}");
    const Model model = build_model(scenario, 0);
    ASSERT_EQ(model.vehicles.size(), 2u);
    ASSERT_EQ(model.drivers.size(), 2u);  // the same driver with two vehicles
    EXPECT_EQ(model.policies.size(), 4u);
    EXPECT_EQ(model.vehicle_of(1).length_m, 5.15);
    EXPECT_EQ(model.vehicle_of(3).length_m, 12.0);
    EXPECT_EQ(model.classes[2].driver, model.classes[3].driver);
    EXPECT_EQ(model.policies[2].settings.name, "CDG-6m_city_bus_12m");
}

// The limit of platoons applies to all vehicles, whichever component sets it. Both fidelities compute the same limit.
TEST(Fleets, AnyComponentMaySetTheLimitOfPlatoons) {
    const std::string limited = "{policy: CDG, share: 60 %, driver: {base: startup_kit, platoon: {max_vehicles: 3}}}";
    const std::string free = "{policy: CDG-6m, share: 40 %, driver: {base: startup_kit}}";
    EXPECT_EQ(build_model(with_components(limited + ", " + free), 0).v2v_plan.max_platoon, 3);
    EXPECT_EQ(build_model(with_components(free + ", " + limited), 0).v2v_plan.max_platoon, 3);
    EXPECT_THROW(with_components(limited + ", {policy: CDG, share: 40 %, driver: {base: startup_kit, platoon: "
                                           "{max_vehicles: 4}}}"),
                 InputError);
    const std::vector<std::string> stable{"driver.platoon.max_vehicles=by_stability",
                                          "driver.v2v={channel: bernoulli, loss: 10 %}"};
    const int full = build_model(with_components("{policy: CDG, share: 100 %}", stable), 0).v2v_plan.max_platoon;
    std::vector<std::string> meso = stable;
    meso.emplace_back("fidelity=meso");
    EXPECT_GT(full, 1);
    EXPECT_EQ(build_model(with_components("{policy: CDG, share: 100 %}", meso), 0).v2v_plan.max_platoon, full);
}

// The canonical text of a scenario defines its hash. A scenario without own vehicles must not mention them.
TEST(Fleets, CanonicalTextHasOnlyOwnVehicles) {
    const auto count = [](const std::string& text, const std::string& part) {
        int found = 0;
        for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
        return found;
    };
    EXPECT_EQ(count(canonical_text(with_components("{policy: CDG, share: 100 %}")), "frontal_area:"), 1);
    EXPECT_EQ(count(canonical_text(with_components(kCarsAndLorries)), "frontal_area:"), 3);
}

TEST(Fleets, CanonicalTextLoadsAgain) {
    const Scenario scenario = with_components(kCarsAndLorries);
    const std::string text = canonical_text(scenario);
    EXPECT_EQ(canonical_text(parse_scenario(text, "again")), text);
}

std::string message_of(const std::string& components, const std::vector<std::string>& overrides = {}) {
    try {
        with_components(components, overrides);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(Fleets, DriversMustAgreeInWhatAllVehiclesShare) {
    const std::string message = message_of(
        "{policy: CDG, share: 50 %}, "
        "{policy: CDG, share: 50 %, driver: {base: startup_kit, cacc: {deceleration_emergency: 5 m/s2}}}");
    EXPECT_NE(message.find("populations[X].components[1].driver"), std::string::npos) << message;
    EXPECT_NE(message.find("cacc.deceleration_emergency is 5 m/s2"), std::string::npos) << message;
    EXPECT_NE(message.find("7 m/s2"), std::string::npos) << message;
}

TEST(Fleets, DriversMayBrakeDifferentlyBeforeLowerLimits) {
    const std::string components =
        "{policy: CDG, share: 50 %}, "
        "{policy: CDG, share: 50 %, driver: {base: startup_kit, free_drive: {deceleration: 1 m/s2}}}";
    EXPECT_EQ(message_of(components), "");
    EXPECT_EQ(message_of(components, {"fidelity=meso"}), "");
}

TEST(Fleets, ChecksUseTheDriversOfTheComponents) {
    const std::string components = "{policy: CDG, share: 100 %, driver: {base: startup_kit, cacc: {v2v_delay: 10 ms}}}";
    const std::string message = message_of(components, {"step=20 ms"});
    EXPECT_NE(message.find("must be at most driver.cacc.v2v_delay, 10 ms"), std::string::npos) << message;
}

TEST(Fleets, WrongVehiclesAreRefusedWithTheirField) {
    const std::string unknown = message_of("{policy: CDG, share: 100 %, vehicle: articulated_lory_35t}");
    EXPECT_NE(unknown.find("articulated_lorry_35t"), std::string::npos) << unknown;
    const std::string slippery =
        message_of("{policy: CDG, share: 100 %, vehicle: {base: city_bus_12m, brake_friction: 0.5}}");
    EXPECT_NE(slippery.find("populations[X].components[0].vehicle.brake_friction"), std::string::npos) << slippery;
}

// A lorry whose brakes respond later than those of the car ahead comes nearer in a hard stop.
TEST(Fleets, ConstantDistancesCoverLaterBrakes) {
    const std::string cars_and_lorries =
        "{policy: CDG, share: 90 %}, {policy: CDG, share: 10 %, vehicle: articulated_lorry_35t, driver: lorry}";
    const std::string message = message_of(cars_and_lorries);
    EXPECT_NE(message.find("populations[X].components[1].policy"), std::string::npos) << message;
    EXPECT_NE(message.find("100 ms later"), std::string::npos) << message;
    EXPECT_EQ(message_of(cars_and_lorries, {"fidelity=meso"}), "");
    EXPECT_EQ(message_of("{policy: CDG, share: 100 %, vehicle: articulated_lorry_35t, driver: lorry}"), "");
}

// The check that a queue fits on the approach uses the mean length of the vehicles.
TEST(Fleets, QueueMustFitOnTheApproach) {
    const std::vector<std::string> road{"network.approach.length=200 m", "demand.vehicles=20"};
    EXPECT_EQ(message_of("{policy: CDG, share: 100 %}", road), "");
    const std::string message = message_of(
        "{policy: CDG, share: 70 %}, {policy: CDG-6m, share: 30 %, vehicle: articulated_lorry_35t, driver: lorry}",
        road);
    EXPECT_NE(message.find("network.approach.length"), std::string::npos) << message;
}

}  // namespace
}  // namespace stopline
