// Where a start outside the band of measured ones: also between the measured points.
#include <gtest/gtest.h>

#include <string>

#include "calibration/startup.h"
#include "calibration/startup_report.h"
#include "scenario/load_scenario.h"

namespace stopline {
namespace {

// Points every second, 2 m/s2, the band as wide as +-0.1 m/s more each second.
StartupCurve curve() {
    StartupCurve curve;
    curve.time_s = {0.0, 1.0, 2.0, 3.0};
    curve.mean_mps = {0.0, 2.0, 4.0, 6.0};
    curve.mean_ci_mps = {0.0, 0.1, 0.2, 0.3};
    return curve;
}

StartupRun run_of(const std::vector<double>& times_s, const std::vector<double>& from_mean_mps) {
    StartupRun run;
    for (std::size_t k = 0; k < times_s.size(); ++k) {
        run.time_s.push_back(times_s[k]);
        run.speed_mps.push_back(2.0 * times_s[k] + from_mean_mps[k]);
        run.distance_m.push_back(0.0);
        run.gear.push_back(1);
    }
    return run;
}

TEST(Startup, ExitsBetweenMeasuredPointsAreFound) {
    const StartupRun run = run_of({0.0, 1.0, 1.25, 1.5, 1.75, 2.0, 2.5, 3.0}, {0, 0, 0.12, 0.2, -0.3, 0, 0.24, 0});
    const std::vector<BandExit> exits = band_exits(curve(), run, true);
    ASSERT_EQ(exits.size(), 2u);
    EXPECT_EQ(exits[0].from_s, 1.5);  // 0.12 at 1.25 s is within 0.125; the other side is an exit of its own
    EXPECT_EQ(exits[0].to_s, 1.5);
    EXPECT_NEAR(exits[0].largest_deviation_mps, 0.2, 1e-12);
    EXPECT_EQ(exits[1].from_s, 1.75);
    EXPECT_NEAR(exits[1].largest_deviation_mps, -0.3, 1e-12);
}

// The shipped start against startup_fine.csv: ahead of the mean until each of the first two gear changes.
TEST(Startup, ReportSaysWhereAndWhyTheShippedStartLeavesTheBand) {
    const StartupReport report =
        report_startup(load_scenario(STOPLINE_SOURCE_DIR "/scenarios/single_light.yaml"),
                       load_startup_curve(STOPLINE_SOURCE_DIR "/data/startup/kit_curve_leader50.csv"));
    const std::string text = startup_text(report);
    const std::string of_mean = text.substr(text.find("outside the 95 % interval"));
    EXPECT_NE(of_mean.find("2.55 to  2.90 s, by +"), std::string::npos) << text;
    EXPECT_NE(of_mean.find("ahead until gear change 1-2 at 2.80 s"), std::string::npos) << text;
    EXPECT_NE(of_mean.find("7.15 to  7.20 s, by +"), std::string::npos) << text;
    EXPECT_NE(of_mean.find("ahead until gear change 2-3 at 7.25 s"), std::string::npos) << text;
    EXPECT_NE(of_mean.find("0.00 to  0.05 s, by +"), std::string::npos) << text;
    EXPECT_NE(of_mean.find("0.15 to  0.85 s, by -"), std::string::npos) << text;
    EXPECT_EQ(of_mean.find("3-4"), std::string::npos) << text;
}

}  // namespace
}  // namespace stopline
