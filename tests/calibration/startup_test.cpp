// Tests of the start-up calibration: the fit of human drivers, and the time intervals ('exits') in which a simulated
// start leaves the band of measured starts.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "calibration/startup.h"
#include "calibration/startup_report.h"
#include "scenario/load_scenario.h"

namespace stopline {
namespace {

// Returns a measured start with 2 m/s2 and one point per second. In each second, the band of measured starts becomes
// wider by 0.1 m/s on each side.
StartupCurve curve() {
    StartupCurve curve;
    curve.time_s = {0.0, 1.0, 2.0, 3.0};
    curve.mean_mps = {0.0, 2.0, 4.0, 6.0};
    curve.mean_ci_mps = {0.0, 0.1, 0.2, 0.3};
    return curve;
}

// Returns a start with the given deviations from the mean speed.
StartupRun run_of(const std::vector<double>& times_s, const std::vector<double>& deviations_mps) {
    StartupRun run;
    for (std::size_t k = 0; k < times_s.size(); ++k) {
        run.time_s.push_back(times_s[k]);
        run.speed_mps.push_back(2.0 * times_s[k] + deviations_mps[k]);
        run.distance_m.push_back(0.0);
        run.gear.push_back(1);
    }
    return run;
}

TEST(Startup, FindsExitsBetweenMeasuredPoints) {
    const StartupRun run = run_of({0.0, 1.0, 1.25, 1.5, 1.75, 2.0, 2.5, 3.0}, {0, 0, 0.12, 0.2, -0.3, 0, 0.24, 0});
    const std::vector<BandExit> exits = band_exits(curve(), run, true);
    ASSERT_EQ(exits.size(), 2u);
    // At 1.25 s the deviation of 0.12 m/s is within the band of 0.125 m/s. Exits above and below the band are separate.
    EXPECT_EQ(exits[0].from_s, 1.5);
    EXPECT_EQ(exits[0].to_s, 1.5);
    EXPECT_NEAR(exits[0].largest_deviation_mps, 0.2, 1e-12);
    EXPECT_EQ(exits[1].from_s, 1.75);
    EXPECT_NEAR(exits[1].largest_deviation_mps, -0.3, 1e-12);
}

// The simulated start is faster than the measured mean before each of the first two gear changes.
// The closed form of the intelligent driver model for a high desired speed is v = a t. The fit of a curve of the model
// returns the acceleration of this curve.
TEST(Startup, FitsTheAccelerationOfHumanDrivers) {
    EXPECT_NEAR(fit_idm_acceleration_mps2(curve(), 1e3), 2.0, 1e-3);
    EXPECT_NEAR(idm_deviation_mps(curve(), 1.5, 1e3), 0.5 * std::sqrt((1.0 + 4.0 + 9.0) / 4.0), 1e-6);
}

// The shipped driver has the acceleration that the fit to the shipped starts gives.
TEST(Startup, ShippedDriverHasTheFittedAccelerationOfHumanDrivers) {
    const StartupCurve starts =
        load_startup_curve(std::string(STOPLINE_SOURCE_DIR) + "/data/startup/kit_curve_leader50.csv");
    const Scenario scenario = load_scenario(STOPLINE_SOURCE_DIR "/scenarios/single_light.yaml");
    const double fitted_mps2 = fit_idm_acceleration_mps2(starts, scenario.network.approach.speed_limit_mps);
    EXPECT_NEAR(scenario.driver.human.idm.acceleration_mps2, fitted_mps2, 0.005);
}

TEST(Startup, ReportNamesTheExitsOfTheShippedStartAndTheirCauses) {
    const StartupReport report =
        report_startup(load_scenario(STOPLINE_SOURCE_DIR "/scenarios/single_light.yaml"),
                       load_startup_curve(STOPLINE_SOURCE_DIR "/data/startup/kit_curve_leader50.csv"));
    const std::string text = startup_text(report);
    const std::string mean_section = text.substr(text.find("outside the 95 % interval"));
    EXPECT_NE(mean_section.find("2.55 to  2.90 s, by +"), std::string::npos) << text;
    EXPECT_NE(mean_section.find("ahead until gear change 1-2 at 2.80 s"), std::string::npos) << text;
    EXPECT_NE(mean_section.find("7.15 to  7.20 s, by +"), std::string::npos) << text;
    EXPECT_NE(mean_section.find("ahead until gear change 2-3 at 7.25 s"), std::string::npos) << text;
    EXPECT_NE(mean_section.find("0.00 to  0.05 s, by +"), std::string::npos) << text;
    EXPECT_NE(mean_section.find("0.15 to  0.85 s, by -"), std::string::npos) << text;
    EXPECT_EQ(mean_section.find("3-4"), std::string::npos) << text;
}

}  // namespace
}  // namespace stopline
