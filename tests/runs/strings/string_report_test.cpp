// Tests of platoons in full dynamics against the linear analysis.
#include "runs/strings/string_report.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/input_error.h"
#include "runs/strings/string_csv.h"
#include "runs/strings/string_sweep.h"
#include "scenario/load_scenario.h"

namespace stopline {
namespace {

Scenario light(const std::string& populations, std::vector<std::string> overrides = {}) {
    overrides.push_back("populations=" + populations);
    return parse_scenario("{network: {kind: approach}, signal: {green: 20 s}}", "strings.yaml", overrides);
}

StringOptions swings(const Scenario& scenario, std::vector<double> frequencies_radps, int vehicles = 8) {
    StringOptions options;
    options.vehicles = vehicles;
    options.speed_mps = default_string_speed_mps(scenario);
    options.frequencies_radps = std::move(frequencies_radps);
    options.brakes = options.starts = false;
    return options;
}

TEST(Strings, GainsEqualThoseOfTheLinearAnalysis) {
    struct Case {
        const char* populations;
        const char* delay;
        bool grows;
    };
    for (const Case& c : {Case{"[CDG]", "20 ms", true}, Case{"[CDG]", "100 ms", true},
                          Case{"[CTG-Ref]", "20 ms", false}, Case{"[CTG-Ref]", "300 ms", true}}) {
        const Scenario scenario = light(c.populations, {std::string("driver.cacc.v2v_delay=") + c.delay});
        const StringReport report = run_strings(scenario, swings(scenario, {0.3, 0.6, 1.5, 4.0}));
        const StringResult& result = report.populations[0];
        EXPECT_TRUE(report.no_violations());
        EXPECT_TRUE(result.was_settled);
        ASSERT_TRUE(result.model.has_value());
        ASSERT_EQ(result.swings.size(), 4U);
        for (const SwingResult& swing : result.swings) {
            EXPECT_NEAR(swing.measured.mean, swing.linear_gain, 0.004)
                << c.populations << ' ' << c.delay << ", " << swing.frequency_radps << " rad/s";
        }
        EXPECT_EQ(result.worst_swing()->measured.mean > 1.0 + kSwingTolerance, c.grows) << c.populations << c.delay;
    }
}

TEST(Strings, StepOfTheSimulationChangesTheGainsAsTheLinearAnalysisSays) {
    for (const char* step : {"5 ms", "20 ms"}) {
        const Scenario scenario = light("[CDG]", {std::string("step=") + step});
        const StringReport report = run_strings(scenario, swings(scenario, {4.0}));
        const SwingResult& swing = report.populations[0].swings[0];
        EXPECT_NEAR(swing.measured.mean, swing.linear_gain, 0.003) << step;
    }
}

TEST(Strings, BrakeAndStartAreWithoutOverlaps) {
    const Scenario scenario = light("[CDG, CTG-Ref, HUMAN]");
    StringOptions options = swings(scenario, {});
    options.brakes = options.starts = true;
    const StringReport report = run_strings(scenario, options);
    EXPECT_TRUE(report.no_violations());
    for (const StringResult& result : report.populations) {
        ASSERT_EQ(result.manoeuvres.size(), 2U);
        const ManoeuvreResult& brake = result.manoeuvres[0];
        EXPECT_EQ(brake.kind, Manoeuvre::Kind::brake);
        EXPECT_GT(brake.measures.smallest_gap_m, 0.0);
        EXPECT_GE(brake.measures.positions[0].linf_mps2, options.deceleration_mps2);
        const std::size_t last = brake.motion.samples - 1;
        EXPECT_NEAR(brake.motion.value(brake.motion.speed_mps, 0, 0), options.speed_mps, 0.1);
        const ManoeuvreResult& start = result.manoeuvres[1];
        for (std::size_t position = 0; position < brake.motion.vehicles; ++position) {
            EXPECT_EQ(brake.motion.value(brake.motion.speed_mps, last, position), 0.0) << result.population;
            EXPECT_LT(start.motion.value(start.motion.speed_mps, 0, position), 0.1) << result.population;
        }
        EXPECT_GT(start.motion.value(start.motion.speed_mps, start.motion.samples - 1, 0), 12.0);
    }
    // With a constant distance the first follower uses up a part of its gap, because its brake responds later.
    EXPECT_GT(report.populations[0].manoeuvres[0].measures.largest_used_share, 0.1);
    EXPECT_TRUE(report.populations[2].model == std::nullopt);
}

TEST(Strings, ThreadsChangeNothing) {
    const Scenario scenario = light("[CDG, CTG-Ref]");
    StringOptions options = swings(scenario, {1.0, 2.0}, 4);
    options.brakes = true;
    const StringReport one = run_strings(scenario, options);
    options.threads = 2;
    const StringReport two = run_strings(scenario, options);
    EXPECT_EQ(string_summary_csv(one), string_summary_csv(two));
    EXPECT_EQ(string_positions_csv(one), string_positions_csv(two));
    for (std::size_t k = 0; k < 2; ++k) EXPECT_EQ(one.populations[k].state_hashes, two.populations[k].state_hashes);
}

TEST(Strings, PopulationsWithoutLinearModelHaveNoLinearGain) {
    const Scenario scenario =
        light("[{name: MIX, components: [{policy: CDG, share: 50 %}, {policy: CTG-Ref, share: 50 %}]}]");
    const StringReport report = run_strings(scenario, swings(scenario, {1.0}, 4));
    EXPECT_FALSE(report.populations[0].model.has_value());
    EXPECT_TRUE(std::isnan(report.populations[0].swings[0].linear_gain));
    EXPECT_GT(report.populations[0].swings[0].measured.mean, 0.3);
    EXPECT_TRUE(report.no_violations());
}

TEST(Strings, RefuseScenariosWithoutARoadInFullDynamics) {
    const Scenario meso = light("[CDG]", {"fidelity=meso"});
    EXPECT_THROW(run_strings(meso, swings(meso, {1.0})), InputError);
    const Scenario grid = load_scenario(STOPLINE_SOURCE_DIR "/scenarios/grid.yaml", {"fidelity=full"});
    EXPECT_THROW(run_strings(grid, swings(grid, {1.0})), InputError);
}

TEST(StringSweep, FindsTheBorderOfTheLinearAnalysis) {
    const Scenario scenario = light("[CTG-Ref]");
    const StringSweep sweep =
        sweep_strings(scenario, swings(scenario, spaced_frequencies_radps(0.3, 1.2, 6), 10), {{0.1}, {0.6, 0.8}});
    ASSERT_EQ(sweep.points.size(), 2U);
    EXPECT_GT(sweep.points[0].measured_gain, 1.0 + kSwingTolerance);
    EXPECT_LT(sweep.points[1].measured_gain, 1.0 + kSwingTolerance);
    ASSERT_EQ(sweep.border.size(), 1U);
    EXPECT_NEAR(sweep.border[0].measured_time_gap_s, sweep.border[0].linear_time_gap_s, 0.05);
    const Scenario distance = light("[CDG]");
    EXPECT_THROW(sweep_strings(distance, swings(distance, {1.0}), {{0.1}, {0.5}}), InputError);
}

}  // namespace
}  // namespace stopline
