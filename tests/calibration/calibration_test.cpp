// Tests of step I of the calibration. It pairs the times at which vehicles pass detectors in two fidelities, measures
// how well the times agree, and fits the parameters of the mesoscale mode.
#include "calibration/calibration.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "scenario/build_model.h"
#include "scenario/load_scenario.h"

namespace stopline {
namespace {

TEST(PairUp, PairsEqualIndicesAndCountsTheSurplus) {
    const PairedTimes paired = pair_up({{1.0, 2.0, 3.0}, {}, {5.0}}, {{1.5, 2.0}, {7.0}, {4.0}});
    ASSERT_EQ(paired.pairs.size(), 3u);
    EXPECT_DOUBLE_EQ(paired.pairs[0].difference_s(), 0.5);
    EXPECT_EQ(paired.pairs[1].k, 1);
    EXPECT_EQ(paired.pairs[2].detector, 2);
    EXPECT_DOUBLE_EQ(paired.pairs[2].difference_s(), -1.0);
    EXPECT_EQ(paired.unpaired_count(), 2);
    EXPECT_EQ(paired.unpaired, (std::map<int, int>{{0, 1}, {1, 1}}));
}

TEST(Agreement, CountsPairsWithinTheLimitAndInDifferentGreens) {
    const PairedTimes paired = pair_up({{1.0, 2.0, 3.0, 50.0}}, {{1.2, 3.0, 4.5, 80.0, 90.0}});
    const PermutationPairs permutation{&paired, 46.0};
    const Agreement a = agreement({&permutation, 1}, 1.0);
    EXPECT_EQ(a.pairs, 4u);
    EXPECT_EQ(a.unpaired, 1u);
    EXPECT_DOUBLE_EQ(a.within_share, 2.0 / 5.0);
    EXPECT_EQ(a.other_green, 1u);
    EXPECT_DOUBLE_EQ(a.largest_s, 30.0);
}

// A signal that never changes again has the cycle 0. All vehicles use the same green, however late they are.
TEST(Agreement, HasNoOtherGreenWithoutACycle) {
    const PairedTimes paired = pair_up({{1.0, 2.0, 50.0}}, {{1.0, 3.0, 80.0}});
    const PermutationPairs permutation{&paired, 0.0};
    EXPECT_EQ(agreement({&permutation, 1}, 1.0).other_green, 0u);
}

TEST(FitLoss, IsZeroForEqualTimesAndNearOneForDistantTimes) {
    EXPECT_DOUBLE_EQ(fit_loss(pair_up({{1.0, 2.0}}, {{1.0, 2.0}}), 1.0), 0.0);
    EXPECT_DOUBLE_EQ(fit_loss(pair_up({{1.0}}, {{2.0}}), 1.0), 0.5);
    EXPECT_DOUBLE_EQ(fit_loss(pair_up({{1.0}}, {{}}), 1.0), 1.0);
    EXPECT_GT(fit_loss(pair_up({{1.0}}, {{40.0}}), 1.0), 0.99);
}

// Returns cases for the fit. Their reference times come from the mesoscale mode with the parameters `truth`, not from
// full dynamics, so a fit should find these parameters again.
std::vector<FitCase> cases_with_known_parameters(const MesoSettings& truth) {
    std::vector<FitCase> cases;
    const Scenario scenario =
        load_scenario(STOPLINE_SOURCE_DIR "/scenarios/calibration.yaml", {"fidelity=meso", "demand.vehicles=8"});
    for (const std::size_t population : {std::size_t{0}, scenario.populations.size() - 1}) {
        FitCase c{scenario, build_model(scenario, population), {}, false};
        c.reference = run_case(c, truth).times;
        cases.push_back(std::move(c));
    }
    return cases;
}

FitOptions short_fit() {
    FitOptions options;
    options.starts = 1;
    options.evaluations_per_start = 60;
    options.joint_evaluations = 40;
    return options;
}

TEST(SlowFit, RecoversKnownParameters) {
    const MesoSettings truth = load_meso("fitted");
    MesoSettings start = truth;
    start.constant_time.reaction_s += 0.2;
    start.constant_distance.acceleration_mps2 *= 0.8;
    const std::vector<FitCase> cases = cases_with_known_parameters(truth);
    FitOptions options = short_fit();
    options.evaluations_per_start = 200;
    const MesoFit fit = fit_meso(cases, start, options);
    EXPECT_LT(fit.history.back().loss, 0.5 * fit.history.front().loss);
    EXPECT_NEAR(fit.settings.constant_time.reaction_s, truth.constant_time.reaction_s, 0.06);
}

// A continued search does not repeat stored evaluations, and it tries the same parameters as an uninterrupted search.
TEST(SlowFit, ContinuesOnTheSamePathFromStoredEvaluations) {
    const std::vector<FitCase> cases = cases_with_known_parameters(load_meso("fitted"));
    const MesoSettings start = load_meso("start");
    FitOptions options = short_fit();
    const MesoFit whole = fit_meso(cases, start, options);
    std::size_t computed = 0;
    options.threads = 2;
    options.stored_loss = [&](std::size_t index, const std::vector<double>& values) -> std::optional<double> {
        if (index >= 70 || whole.history[index].values != values) return std::nullopt;
        return whole.history[index].loss;
    };
    options.on_evaluation = [&](std::size_t, const FitEvaluation&) { ++computed; };
    const MesoFit continued = fit_meso(cases, start, options);
    ASSERT_EQ(continued.history.size(), whole.history.size());
    EXPECT_EQ(computed, whole.history.size() - 70);
    EXPECT_EQ(continued.history.back().values, whole.history.back().values);
    EXPECT_EQ(meso_yaml(continued.settings, ""), meso_yaml(whole.settings, ""));
}

}  // namespace
}  // namespace stopline
