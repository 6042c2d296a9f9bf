// Results of the single-light experiment: counts, comparisons with the baseline, tables and provenance.
#include "runs/single_light/single_light.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "base/io/csv.h"
#include "runs/provenance.h"
#include "runs/short_scenario.h"
#include "runs/single_light/single_light_csv.h"
#include "scenario/scenario_text.h"

namespace stopline {
namespace {

TEST(RunPopulations, GivesTheSameBitsForAnyNumberOfThreads) {
    const Scenario scenario = short_scenario();
    const std::vector<RunResult> one = run_populations(scenario, {1, 0.1, 45.0, 90.0, {}});
    const std::vector<RunResult> three = run_populations(scenario, {3, 0.1, 45.0, 90.0, {}});
    ASSERT_EQ(one.size(), 3U);
    for (std::size_t k = 0; k < one.size(); ++k) {
        EXPECT_EQ(one[k].population, scenario.populations[k].name);
        EXPECT_EQ(three[k].population, scenario.populations[k].name);
        EXPECT_EQ(one[k].state_hash, three[k].state_hash);
        EXPECT_EQ(one[k].stop_line_times_s, three[k].stop_line_times_s);
        EXPECT_TRUE(one[k].complete);
    }
}

TEST(RunPopulations, ReportsRisingProgressThatEndsAtOne) {
    double last = 0.0;
    RunAllOptions options;
    options.on_progress = [&](double share) {
        EXPECT_GE(share, last);
        last = share;
        return true;
    };
    run_populations(short_scenario(), options);
    EXPECT_DOUBLE_EQ(last, 1.0);
}

TEST(RunPopulations, StopsOnRequest) {
    std::atomic<int> calls = 0;
    RunAllOptions options;
    options.threads = 2;
    options.on_progress = [&](double) { return ++calls < 3; };
    EXPECT_THROW(run_populations(short_scenario(), options), Interrupted);
    EXPECT_EQ(calls, 3) << "progress was reported after the request to stop";
}

TEST(RunPopulations, PassesOnTheErrorOfARun) {
    Scenario scenario = short_scenario();
    scenario.populations[1].components[0].policy = "none";
    RunAllOptions options;
    options.threads = 2;
    const std::string error = input_error_of([&] { run_populations(scenario, options); });
    EXPECT_TRUE(contains(error, "unknown policy 'none'"));
}

TEST(SingleLight, SummaryAgreesWithRunsAndBaseline) {
    const SingleLightReport result = run_single_light(short_scenario());
    ASSERT_EQ(result.baseline, 2U);
    EXPECT_TRUE(result.no_violations());
    const PopulationSummary& base = result.populations[2];
    for (std::size_t k = 0; k < result.populations.size(); ++k) {
        const PopulationSummary& summary = result.populations[k];
        ASSERT_EQ(summary.passed.size(), 3U);
        for (std::size_t i = 0; i < 3; ++i) {
            const double green_s = result.scenario.measure.green_s[i];
            EXPECT_EQ(summary.passed[i], result.runs[k].passed_within(green_s));
            EXPECT_DOUBLE_EQ(summary.improvement_percent[i], 100.0 * summary.passed[i] / base.passed[i] - 100.0);
        }
        EXPECT_EQ(summary.line.size(), static_cast<std::size_t>(summary.counter.total()));
    }
    EXPECT_GT(result.populations[0].passed[1], base.passed[1]);
    EXPECT_EQ(result.find("MIX"), &result.populations[1]);
    EXPECT_EQ(result.find("SWITCH-1"), nullptr);
}

TEST(SingleLight, SteadyHeadwaysAgreeWithThePolicies) {
    const SingleLightReport result = run_single_light(short_scenario());
    const double length_m = result.scenario.vehicle.length_m;
    const double v = result.scenario.network.approach.speed_limit_mps;
    const double near = (length_m + 2.95) / v;
    const double far = (length_m + 2.95 + 0.87 * v) / v;
    const std::vector<double> expected{near, 0.5 * (near + far), far};
    for (std::size_t k = 0; k < 3; ++k) {
        const SteadyFlow& steady = result.populations[k].steady;
        EXPECT_NEAR(steady.policy_headway_s, expected[k], 1e-12);
        EXPECT_GT(steady.vehicles, 0);
        EXPECT_NEAR(steady.headway_s, steady.policy_headway_s, 0.01 * steady.policy_headway_s);
    }
    EXPECT_NEAR(result.populations[0].asymptotic_improvement_percent, 100.0 * (far / near - 1.0), 3.0);
}

TEST(SingleLight, MeanImprovementEndsWhenAQueueIsEmpty) {
    const SingleLightReport result = run_single_light(short_scenario());
    const PopulationSummary& cdg = result.populations[0];
    const PopulationSummary& base = result.populations[2];
    ASSERT_FALSE(std::isnan(cdg.emptied_s)) << "the twelve vehicles of CDG pass within 20 s";
    EXPECT_DOUBLE_EQ(result.mean_improvement_percent(cdg, 5.0),
                     mean_improvement_percent(cdg.counter, base.counter, 5.0, cdg.emptied_s));
    EXPECT_TRUE(std::isnan(result.mean_improvement_percent(cdg, cdg.emptied_s + 0.1)));
    EXPECT_DOUBLE_EQ(result.mean_improvement_percent(base, 5.0), 0.0);
}

TEST(SingleLight, ResultsDoNotDependOnTheSamplingInterval) {
    SingleLightOptions fine;
    fine.trajectory_interval_s = 0.03;
    const SingleLightReport plain = run_single_light(short_scenario());
    const SingleLightReport sampled = run_single_light(short_scenario(), fine);
    EXPECT_EQ(summary_csv(plain), summary_csv(sampled));
    EXPECT_GT(sampled.runs[0].trajectory.size(), plain.runs[0].trajectory.size());
    for (const TrajectoryPoint& point : thin_out(sampled.runs[0].trajectory, 0.03, 0.01)) {
        EXPECT_NEAR(std::remainder(point.time_s, 0.03), 0.0, 1e-9);
    }
}

TEST(SingleLight, HasNoImprovementWithoutABaseline) {
    Scenario scenario = short_scenario();
    scenario.measure.baseline.clear();
    const SingleLightReport result = run_single_light(scenario);
    EXPECT_FALSE(result.baseline);
    EXPECT_TRUE(std::isnan(result.populations[0].improvement_percent[0]));
    EXPECT_TRUE(std::isnan(result.mean_improvement_percent(result.populations[0], 5.0)));
    EXPECT_TRUE(contains(improvement_csv(result), "\nCDG,5.000,"));
}

TEST(SingleLightCsv, HasTheRightNumberOfRows) {
    const SingleLightReport result = run_single_light(short_scenario());
    EXPECT_EQ(parse_csv(summary_csv(result), "summary").rows.size(), 3U);
    EXPECT_EQ(parse_csv(improvement_csv(result), "improvement").rows.size(), 9U);
    const CsvTable passages = parse_csv(passages_csv(result), "passages");
    std::size_t passed = 0;
    for (const PopulationSummary& summary : result.populations) passed += summary.line.size();
    EXPECT_EQ(passages.rows.size(), passed);
    const CsvTable trajectories = parse_csv(trajectories_csv(result, 1.0), "trajectories");
    // One row per second, from 5 s before the start of the green of 20 s to 25 s after its end, for twelve vehicles and
    // three populations.
    EXPECT_EQ(trajectories.rows.size(), 51U * 12U * 3U);
}

TEST(Provenance, ContainsTheScenarioAndNoDate) {
    const Scenario scenario = short_scenario({"seed=7"});
    const std::string json = provenance_json(scenario, {"stopline-run short.yaml", {"a.csv"}, {{"CDG", "00ff"}}});
    EXPECT_TRUE(contains(json, "\"seed\": 7"));
    EXPECT_TRUE(contains(json, "stopline-run short.yaml"));
    EXPECT_TRUE(contains(json, "\"CDG\": \"00ff\""));
    EXPECT_TRUE(contains(json, "vehicles: 12"));
    EXPECT_EQ(json, provenance_json(scenario, {"stopline-run short.yaml", {"a.csv"}, {{"CDG", "00ff"}}}));
}

}  // namespace
}  // namespace stopline
