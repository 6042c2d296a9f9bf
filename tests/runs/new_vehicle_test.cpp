// A vehicle and a driver in files of their own need no code: populations name the files, in both fidelities.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/io/csv.h"
#include "runs/short_scenario.h"
#include "runs/single_light/single_light.h"
#include "runs/single_light/single_light_csv.h"
#include "scenario/build_model.h"
#include "scenario/scenario_text.h"

namespace stopline {
namespace {

class NewVehicle : public testing::TestWithParam<const char*> {};

TEST_P(NewVehicle, DrivesFromItsFile) {
    const TemporaryFolder folder;
    folder.write("tram.yaml", "base: city_bus_12m\nlength: 20 m\n");
    folder.write("tram_driver.yaml", "base: bus\ncacc: {acceleration_max: 0.9 m/s2}\n");
    const std::string path = folder.path().string();
    const Scenario scenario = short_scenario(
        {"populations=[{name: X, pattern: alternating, components: [{policy: CTG-Ref, share: 50 %}, {policy: CTG-Ref, "
         "share: 50 %, vehicle: " +
             path + "/tram.yaml, driver: " + path + "/tram_driver.yaml}]}]",
         "measure.baseline=X", "step=20 ms", std::string("fidelity=") + GetParam()});
    const Model model = build_model(scenario, 0);
    ASSERT_EQ(model.classes.size(), 2U);
    EXPECT_EQ(model.vehicle_of(1).length_m, 20.0);
    EXPECT_NE(model.classes[0].driver, model.classes[1].driver);

    const SingleLightReport report = run_single_light(scenario, {});
    EXPECT_TRUE(report.no_violations());
    const CsvTable passages = parse_csv(passages_csv(report), "passages");
    double car_s = 0.0;
    double tram_s = 0.0;
    int trams = 0;
    for (const std::vector<std::string>& row : passages.rows) {
        const std::string& policy = row[passages.column("policy")];
        const double headway_s = parse_number(row[passages.column("headway_s")]).value_or(0.0);
        if (policy == "CTG-Ref") car_s += headway_s;
        if (policy != "CTG-Ref_tram_tram_driver") continue;
        ++trams;
        tram_s += headway_s;
    }
    EXPECT_GT(trams, 1);
    // The headway of a car contains the length of the tram ahead of it.
    EXPECT_GT(car_s, tram_s);
}

INSTANTIATE_TEST_SUITE_P(BothFidelities, NewVehicle, testing::Values("full", "meso"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace stopline
