// The energy of whole runs: balance, columns of all ways of running, and no influence on the run.
#include <gtest/gtest.h>

#include <map>
#include <numeric>
#include <string>

#include "base/input_error.h"
#include "runs/driving/driving_csv.h"
#include "runs/network/network_run.h"
#include "runs/run.h"
#include "runs/run_kind.h"
#include "runs/short_scenario.h"

namespace stopline {
namespace {

RunResult run_short(const std::vector<std::string>& overrides) {
    return run_population(short_scenario(overrides), 0, {});
}

class EnergyOfEveryVehicle : public testing::TestWithParam<const char*> {};

// The work from torque, gear and brake force against the change of kinetic energy and the resistances.
TEST_P(EnergyOfEveryVehicle, ClosesItsBalanceWithinATenthOfAPercent) {
    const RunResult run = run_short({"measure.energy=on", std::string("vehicle=") + GetParam(), "demand.vehicles=6",
                                     "populations=[CTG-Ref]", "measure.baseline=CTG-Ref", "duration=70 s"});
    const EnergyResult& energy = run.driving.energy;
    EXPECT_LT(std::abs(energy.residual_percent()), 0.1);
    for (const double term_J :
         {energy.work.air_J, energy.work.rolling_J, energy.work.brake_J - energy.work.overrun_J}) {
        EXPECT_GT(term_J, 0.02 * energy.work.driven_J);
    }
    EXPECT_DOUBLE_EQ(energy.work.grade_J, 0.0);
}

INSTANTIATE_TEST_SUITE_P(Vehicles, EnergyOfEveryVehicle,
                         testing::Values("petrol_eu4_72kw", "petrol_eu4_84kw", "diesel_eu4_103kw", "electric_100kw",
                                         "city_bus_12m", "rigid_lorry_12t", "articulated_lorry_35t"));

TEST(Energy, ChangesNoRun) {
    for (const char* fidelity : {"fidelity=full", "fidelity=meso"}) {
        const RunResult off = run_short({fidelity});
        const RunResult on = run_short({fidelity, "measure.energy=on"});
        EXPECT_EQ(on.state_hash, off.state_hash);
        EXPECT_EQ(on.updates, off.updates);
        EXPECT_FALSE(off.driving.energy.exists);
        EXPECT_EQ(energy_csv({{"CDG", off.driving}}), "");
        EXPECT_NE(energy_csv({{"CDG", on.driving}}), "");
    }
}

TEST(Energy, OfAllVehiclesIsTheIntegralOfTheSeries) {
    for (const char* vehicle : {"vehicle=petrol_eu4_72kw", "vehicle=electric_100kw"}) {
        const EnergyResult energy = run_short({"measure.energy=on", vehicle}).driving.energy;
        double fuel_g = 0.0;
        double battery_J = 0.0;
        for (const VehicleEnergy& vehicle_energy : energy.vehicles) {
            fuel_g += vehicle_energy.use.fuel_g;
            battery_J += vehicle_energy.use.battery_J;
        }
        const auto integral = [&](const std::vector<double>& rates) {
            return energy.interval_s * std::accumulate(rates.begin(), rates.end(), 0.0);
        };
        EXPECT_NEAR(integral(energy.fuel_g_per_s), fuel_g, 1e-6 * fuel_g);
        EXPECT_NEAR(integral(energy.battery_W), battery_J, 1e-6 * battery_J);
        EXPECT_GT(fuel_g + battery_J, 1.0);
    }
}

// Twelve vehicles stand before the red light in the second before the green begins.
TEST(Energy, AtRestIsTheIdleRate) {
    const Scenario scenario = short_scenario({"measure.energy=on"});
    const EnergyResult energy = run_population(scenario, 0, {}).driving.energy;
    ASSERT_EQ(energy.vehicles.size(), 12u);
    ASSERT_EQ(energy.interval_s, 1.0);
    EXPECT_NEAR(energy.fuel_g_per_s.at(48), 12.0 * scenario.vehicle.energy->idle_fuel_g_per_h / 3600.0, 1e-9);
}

TEST(Energy, IsTheSameForAnyNumberOfThreads) {
    const Scenario scenario = parse_scenario(
        "{fidelity: meso, duration: 100 s, populations: [CTG-Ref], network: {kind: grid, grid: {columns: 2, rows: 1}}, "
        "signal: {first_green: 1 s, green: 15 s}, measure: {energy: on, surrogate_safety: on}}",
        "test.yaml");
    const NetworkResult one = run_network(scenario, 0, {}, 1);
    const NetworkResult two = run_network(scenario, 0, {}, 2);
    EXPECT_EQ(energy_csv({{"CTG-Ref", one.driving}}), energy_csv({{"CTG-Ref", two.driving}}));
    EXPECT_EQ(safety_distributions_csv({{"CTG-Ref", one.driving}}),
              safety_distributions_csv({{"CTG-Ref", two.driving}}));
    EXPECT_EQ(one.driving.energy.fuel_g_per_s, two.driving.energy.fuel_g_per_s);
    EXPECT_GT(one.driving.energy.totals.fuel.vehicles, 10);
}

std::map<std::string, std::string> metrics_of(const Scenario& scenario) {
    std::map<std::string, std::string> values;
    for (const RunMetric& metric : run_kind(scenario).metrics(scenario, 0, [] { return true; })) {
        values[metric.column] = metric.value;
    }
    return values;
}

TEST(Energy, AndSafetyAreMetricsOfAllWaysOfRunning) {
    for (const std::string network :
         {"network: {approach: {length: 200 m}}, signal: {first_green: 30 s, green: 20 s}, demand: {vehicles: 10}, "
          "duration: 80 s, measure: {green: [10 s]",
          "network: {kind: intersection}, signal: {first_green: 1 s, green: 10 s}, measure: {cycles: 1",
          "network: {kind: grid, grid: {columns: 2, rows: 1}}, signal: {first_green: 1 s, green: 10 s}, duration: 160 "
          "s, measure: {window: 100 s"}) {
        Scenario scenario = parse_scenario(
            "{fidelity: meso, populations: [CTG-Ref], " + network + ", energy: on, surrogate_safety: on}}",
            "test.yaml");
        std::map<std::string, std::string> values = metrics_of(scenario);
        EXPECT_GT(std::stod(values["fuel_g_per_km"]), 20.0) << network;
        EXPECT_GT(std::stod(values["co2_g_per_veh"]), 10.0) << network;
        EXPECT_EQ(values["energy_Wh_per_km"], "") << network;
        EXPECT_GT(std::stod(values["net_gap_min_m"]), 0.0) << network;
        EXPECT_GT(std::stod(values["jerk_p99_mps3"]), 0.0) << network;
        scenario.measure.energy = scenario.measure.surrogate_safety = "off";
        values = metrics_of(scenario);
        EXPECT_FALSE(values.contains("fuel_g_per_km")) << network;
        EXPECT_FALSE(values.contains("net_gap_min_m")) << network;
    }
}

TEST(Energy, OfAVehicleWithoutDataIsAnError) {
    constexpr const char* kVehicle = STOPLINE_SOURCE_DIR "/tests/data/no_energy.yaml";
    try {
        short_scenario({"measure.energy=on", std::string("vehicle=") + kVehicle});
        FAIL() << "no error";
    } catch (const InputError& error) {
        const std::string message = error.what();
        EXPECT_NE(message.find("measure.energy"), std::string::npos) << message;
        EXPECT_NE(message.find("'no_energy' has no section energy"), std::string::npos) << message;
    }
    EXPECT_NO_THROW(short_scenario({std::string("vehicle=") + kVehicle}));
}

}  // namespace
}  // namespace stopline
