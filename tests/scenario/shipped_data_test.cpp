// Tests that the shipped vehicles, drivers and policies have the values of their sources and of the paper.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "scenario/scenario_text.h"
#include "spacing_laws/gap_policy.h"
#include "vehicle/powertrain_tables.h"

namespace stopline {
namespace {

double power_kW(const PowertrainSettings& car, double speed_rpm) {
    return interpolate(car.full_load, speed_rpm) * speed_rpm * kRadpsPerRpm / 1000.0;
}

TEST(ShippedVehicles, AllLoadAndCompile) {
    const std::vector<std::string> names = data_names("vehicles");
    EXPECT_GE(names.size(), 7u);
    for (const std::string& name : names) {
        const PowertrainSettings car = load_vehicle(name);
        EXPECT_EQ(car.name, name);
        const bool is_car = car.mass_kg < 3500.0;
        if (is_car) {
            EXPECT_EQ(car.length_m, 5.15) << name;  // the length in the paper, for all cars
        }
        EXPECT_NO_THROW(compile_powertrain(car)) << name;
    }
}

TEST(ShippedVehicles, HaveTheirRatedPower) {
    EXPECT_NEAR(power_kW(load_vehicle("petrol_eu4_72kw"), 5565), 72.0, 0.5);
    EXPECT_NEAR(power_kW(load_vehicle("petrol_eu4_84kw"), 5565), 84.0, 0.5);
    EXPECT_NEAR(power_kW(load_vehicle("diesel_eu4_103kw"), 4073), 103.0, 0.5);
    const PowertrainSettings electric = load_vehicle("electric_100kw");
    for (const double rpm : {3410.0, 5000.0, 8000.0, 12000.0}) EXPECT_NEAR(power_kW(electric, rpm), 100.0, 0.5);
    for (const char* name : {"petrol_eu4_72kw", "petrol_eu4_84kw", "diesel_eu4_103kw", "electric_100kw"}) {
        const PowertrainSettings car = load_vehicle(name);
        const double rated = std::stod(std::string(name).substr(std::string(name).rfind('_') + 1));
        for (int rpm = 0; rpm <= car.limiter_rpm;
             rpm += 50) {  // a coarse curve may exceed the rated power a little between its points
            EXPECT_LE(power_kW(car, rpm), rated * 1.03) << name << " at " << rpm;
        }
    }
}

// Time constant of torque: tau = (420 c - 240) / (2 c) / rpm + 0.1 s with c = 4 cylinders, at most 0.5 s.
TEST(ShippedVehicles, HaveTheLagOfTheFormula) {
    for (const char* name : {"petrol_eu4_72kw", "petrol_eu4_84kw", "diesel_eu4_103kw"}) {
        const PowertrainSettings car = load_vehicle(name);
        ASSERT_EQ(car.lag_torque_share.size(), 2u);
        for (std::size_t i = 0; i < car.lag_rpm.size(); ++i) {
            const double formula_s = std::min(0.5, 180.0 / car.lag_rpm[i] + 0.1);
            EXPECT_NEAR(car.lag_drive_s[2 * i], formula_s, 0.0005) << name << " at " << car.lag_rpm[i];
            EXPECT_EQ(car.lag_drive_s[2 * i], car.lag_drive_s[2 * i + 1]);
        }
        EXPECT_EQ(car.brake_lag_s, 0.2);
    }
}

// Friction mean effective pressures by Heywood, see the comments in the vehicle files.
TEST(ShippedVehicles, HaveTheDragTorqueOfTheFormula) {
    const auto torque_Nm = [](double pressure_bar, double displacement_l) {
        return -pressure_bar * 1e5 * displacement_l * 1e-3 / (4.0 * kPi);
    };
    const auto expect_curve = [&](const PowertrainSettings& car, double displacement_l, auto pressure_bar) {
        for (std::size_t i = 0; i < car.drag_torque.x.size(); ++i) {
            const double expected_Nm = torque_Nm(pressure_bar(car.drag_torque.x[i] / 1000.0), displacement_l);
            EXPECT_NEAR(car.drag_torque.y[i], expected_Nm, 0.06) << car.name << " at " << car.drag_torque.x[i];
        }
    };
    const auto petrol = [](double n) { return 0.97 + 0.15 * n + 0.05 * n * n + 0.65; };
    const auto diesel = [](double n) {
        const double piston_mps = 2.0 * 0.0955 * n * 1000.0 / 60.0;
        return (75.0 + 48.0 * n + 0.4 * piston_mps * piston_mps) / 100.0;
    };
    expect_curve(load_vehicle("petrol_eu4_72kw"), 1.6, petrol);
    expect_curve(load_vehicle("petrol_eu4_84kw"), 1.8, petrol);
    expect_curve(load_vehicle("diesel_eu4_103kw"), 1.968, diesel);
}

TEST(ShippedVehicles, ElectricCarHasOneGearAndNoClutch) {
    const PowertrainSettings car = load_vehicle("electric_100kw");
    EXPECT_EQ(car.gear_ratio.size(), 1u);
    EXPECT_EQ(car.idle_rpm, 0.0);
    EXPECT_EQ(car.launch_rpm, 0.0);
    for (std::size_t i = 0; i < car.drag_torque.x.size(); ++i) {  // the limit of recuperation is 50 kW
        EXPECT_GE(car.drag_torque.x[i] * kRadpsPerRpm * car.drag_torque.y[i], -50.1e3);
    }
}

TEST(ShippedPolicies, MatchThePaper) {
    const std::vector<GapPolicySettings> policies = load_policies();
    const auto gap_m = [&](const std::string& name, double kmh) {
        const auto found =
            std::find_if(policies.begin(), policies.end(), [&](const auto& p) { return p.name == name; });
        EXPECT_NE(found, policies.end()) << name;
        return equilibrium_gap_m(*found, kmh / 3.6);
    };
    for (const GapPolicySettings& policy : policies) {
        if (policy.law == "human") continue;  // not in the paper
        EXPECT_EQ(gap_m(policy.name, 0.0), policy.name == "CDG-6m" ? 6.0 : 2.95) << policy.name;
    }
    // Headway at 50 km/h, in s.
    const auto headway_s = [&](const std::string& name) { return (5.15 + gap_m(name, 50.0)) / (50.0 / 3.6); };
    EXPECT_NEAR(headway_s("CDG"), 0.583, 0.001);
    EXPECT_NEAR(headway_s("CTG-Ref"), 1.453, 0.001);
    EXPECT_NEAR(headway_s("CTG-HBS"), 1.80, 0.005);
    EXPECT_NEAR(headway_s("CTG-HCM"), 1.50, 0.005);
    EXPECT_NEAR(headway_s("SWITCH-1"), 0.931, 0.001);
    EXPECT_NEAR(headway_s("CTG-Ref") / headway_s("CDG-6m"), 1.81, 0.01);
    for (const char* name : {"SWITCH-1", "SWITCH-1-6m", "SWITCH-2"}) EXPECT_NEAR(gap_m(name, 30.0), 2.95, 1e-9);
    EXPECT_NEAR(gap_m("SWITCH-1", 50.0), 7.78, 0.01);
    EXPECT_NEAR(gap_m("SWITCH-1-6m", 50.0), 6.0, 1e-9);
    EXPECT_NEAR(gap_m("SWITCH-2", 50.0), 15.0, 1e-9);
    EXPECT_NEAR(gap_m("SWITCH-2", 40.0), (2.95 + 15.0) / 2.0, 1e-9);
}

TEST(ShippedPolicies, AllLawsAreUsed) {
    const std::vector<GapPolicySettings> policies = load_policies();
    for (const GapLaw* law : gap_laws()) {
        if (law->tabulate != nullptr) continue;  // a law of any shape, for policies of the user
        EXPECT_TRUE(std::any_of(policies.begin(), policies.end(), [&](const auto& p) { return p.law == law->name; }))
            << law->name;
    }
}

TEST(ShippedDrivers, AllLoad) {
    const std::vector<std::string> names = data_names("drivers");
    EXPECT_GE(names.size(), 1u);
    for (const std::string& name : names) EXPECT_EQ(load_driver(name).name, name);
}

TEST(DriverYaml, ReadsBackBitForBit) {
    DriverSettings driver = load_driver("startup_kit");
    driver.name = "mine";
    driver.cacc.feedback_kp_1ps2 = 1.0 / 3.0;
    driver.free_drive.speed_mps = {0.0, 1.0 / 7.0, 13.0 + 8.0 / 9.0};
    driver.free_drive.acceleration_mps2 = {2.0 / 3.0, 0.1 + 0.2, 1e-2};
    driver.free_drive.hesitation_s = std::nextafter(0.5, 1.0);
    const std::string text = driver_yaml(driver, "Fitted to the measured start.\nSecond line.");
    EXPECT_TRUE(contains(text, "# Fitted to the measured start.\n# Second line.\n"));
    const TemporaryFolder folder;
    const DriverSettings reread = load_driver(folder.write("mine.yaml", text).string());
    EXPECT_EQ(reread.name, "mine");
    EXPECT_EQ(reread.cacc.feedback_kp_1ps2, driver.cacc.feedback_kp_1ps2);
    EXPECT_EQ(reread.free_drive.speed_mps, driver.free_drive.speed_mps);
    EXPECT_EQ(reread.free_drive.acceleration_mps2, driver.free_drive.acceleration_mps2);
    EXPECT_EQ(reread.free_drive.hesitation_s, driver.free_drive.hesitation_s);
    EXPECT_EQ(driver_yaml(reread, ""), driver_yaml(driver, ""));
}

}  // namespace
}  // namespace stopline
