#include "figures/driving_figures.h"

#include <gtest/gtest.h>

#include "scenario/load_scenario.h"
#include "scenario/scenario_text.h"

namespace stopline {
namespace {

Scenario two_populations(const std::vector<std::string>& overrides) {
    return parse_scenario("{duration: 400 s, populations: [CDG, CTG-Ref], measure: {green: [10 s]}}", "test.yaml",
                          overrides);
}

std::string data_of(const Figure& figure, const std::string& name) {
    for (const auto& [file, text] : figure.data) {
        if (file == name) return text;
    }
    return "no file " + name;
}

TEST(DrivingFigures, ExistOnlyForTheMeasuresOfTheScenario) {
    EXPECT_TRUE(driving_figures(two_populations({}), {}).empty());
    EXPECT_EQ(driving_figures(two_populations({"measure.energy=on"}), {}).size(), 1u);
    EXPECT_EQ(driving_figures(two_populations({"measure.energy=on", "measure.surrogate_safety=on"}), {}).size(), 2u);
}

TEST(DrivingFigures, ShowFuelAndElectricEnergyOfThePopulationsThatHaveThem) {
    DrivingResults fuel;
    fuel.energy.totals.fuel = {2, 1.5, 90.0, 3};
    fuel.energy.interval_s = 30.0;
    fuel.energy.fuel_g_per_s = {1.0, 2.0};
    fuel.energy.battery_W = {0.0, 0.0};
    const Scenario scenario = two_populations({"measure.energy=on"});
    const Figure only_fuel = driving_figures(scenario, {{"CDG", fuel}}).at(0);
    EXPECT_EQ(data_of(only_fuel, "energy_fuel.dat"), "# index value population\n0 60.0000\n");
    EXPECT_EQ(data_of(only_fuel, "energy_fuel_0.dat"), "# minutes rate\n0.2500 1.00000\n0.7500 2.00000\n");
    EXPECT_EQ(only_fuel.body.find("battery"), std::string::npos);

    DrivingResults electric;
    electric.energy.totals.battery = {1, 2.0, 300.0, 1};
    electric.energy.interval_s = 30.0;
    electric.energy.fuel_g_per_s = {0.0};
    electric.energy.battery_W = {1500.0};
    const Figure both = driving_figures(scenario, {{"CDG", fuel}, {"CTG-Ref", electric}}).at(0);
    EXPECT_EQ(data_of(both, "energy_battery.dat"), "# index value population\n0 NaN\n1 150.0000\n");
    EXPECT_EQ(data_of(both, "energy_battery_1.dat"), "# minutes rate\n0.2500 1.50000\n");
    EXPECT_EQ(both.body.find("energy_battery_0.dat"), std::string::npos);

    EXPECT_NE(driving_figures(scenario, {{"CDG", DrivingResults{}}}).at(0).nothing, "");
}

TEST(DrivingFigures, CanBeDrawnWithoutSamples) {
    if (!gnuplot_installed()) GTEST_SKIP() << "no gnuplot";
    const Scenario scenario = two_populations({"measure.energy=on", "measure.surrogate_safety=on"});
    const TemporaryFolder folder;
    for (const Figure& figure : driving_figures(scenario, {{"CDG", DrivingResults{}}, {"CTG-Ref", DrivingResults{}}})) {
        if (figure.nothing.empty()) {
            EXPECT_EQ(input_error_of([&] { draw(figure, folder.path()); }), "") << figure.name;
        }
    }
}

}  // namespace
}  // namespace stopline
