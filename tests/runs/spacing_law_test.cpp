// This file registers a spacing law with a parameter of its own. Policies can have it, in both fidelities.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "base/input_error.h"
#include "base/io/csv.h"
#include "runs/run_metrics.h"
#include "runs/short_scenario.h"
#include "scenario/schema/fields.h"
#include "spacing_laws/gap_policy.h"

namespace stopline {
namespace {

// The law halves its parameter. Its gap is that of constant_time with half the time gap.
constexpr std::array kParameters{LawParameter{"double_gap", "s", 0, 10, "test: twice the time gap"}};

void halved_time(const GapPolicy& policy, std::span<const double> speed_mps, std::span<double> gap_m,
                 std::span<double> slope_s) {
    const double time_gap_s = 0.5 * policy.values[0];
    for (std::size_t i = 0; i < speed_mps.size(); ++i) {
        gap_m[i] = policy.settings.standstill_gap_m + time_gap_s * speed_mps[i];
        slope_s[i] = time_gap_s;
    }
}

MesoGap halved_time_meso(const GapPolicy& policy) {
    return {kTimeGapFamily, policy.settings.standstill_gap_m, 0.5 * policy.values[0], false};
}

std::vector<LawProblem> problems(const GapPolicySettings& settings) {
    if (law_parameter(settings, "double_gap") != 1.0) return {};
    return {{"double_gap", "this test refuses 1 s"}};
}

constexpr GapLaw kHalvedTime{
    "halved_time", "test: a time gap of half the parameter", kParameters, halved_time, halved_time_meso, problems};

const bool kIsRegistered = (register_gap_law(kHalvedTime), true);

Scenario with_policy(const std::string& law, const std::string& fidelity = "full") {
    return short_scenario({"policies=[{name: OWN, standstill_gap: 3 m, " + law + "}]", "populations=[OWN]",
                           "measure.baseline=OWN", "fidelity=" + fidelity});
}

std::string error_with(const std::string& law) {
    try {
        with_policy(law);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

class SpacingLaw : public testing::TestWithParam<const char*> {};

// A run with the law has the same result as a run with the law that it equals.
TEST_P(SpacingLaw, RunsInBothFidelities) {
    const std::vector<RunMetric> own = run_metrics(with_policy("law: halved_time, double_gap: 2.2 s", GetParam()), 0);
    const std::vector<RunMetric> known = run_metrics(with_policy("law: constant_time, time_gap: 1.1 s", GetParam()), 0);
    ASSERT_EQ(own.size(), known.size());
    for (std::size_t k = 0; k < own.size(); ++k) EXPECT_EQ(own[k].value, known[k].value) << own[k].column;
    const std::vector<RunMetric> other = run_metrics(with_policy("law: constant_time, time_gap: 1 s", GetParam()), 0);
    const auto state_hash = [](const std::vector<RunMetric>& metrics) {
        return std::find_if(metrics.begin(), metrics.end(), [](const RunMetric& m) { return m.column == "state_hash"; })
            ->value;
    };
    EXPECT_NE(state_hash(own), state_hash(other));
}

// A formula and a table need no code. They equal the law of the same gap except for rounding. Only mesoscale runs need
// the name of a car-following model.
TEST_P(SpacingLaw, IsWrittenInTheScenario) {
    const std::vector<RunMetric> known = run_metrics(with_policy("law: constant_time, time_gap: 1.1 s", GetParam()), 0);
    const std::string model = std::string(GetParam()) == "meso" ? ", mesoscale: time_gap" : "";
    for (const char* const law :
         {"law: formula, gap: s0 + 1.1 s * v", "law: table, gaps: {36 km/h: 14 m, 72 km/h: 25 m}"}) {
        const std::vector<RunMetric> own = run_metrics(with_policy(law + model, GetParam()), 0);
        ASSERT_EQ(own.size(), known.size());
        for (std::size_t k = 0; k < own.size(); ++k) {
            if (own[k].column == "state_hash") continue;
            EXPECT_NEAR(parse_number(own[k].value).value_or(-1.0), parse_number(known[k].value).value_or(-1.0), 1e-3)
                << own[k].column << " of " << law;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(BothFidelities, SpacingLaw, testing::Values("full", "meso"),
                         [](const auto& test) { return std::string(test.param); });

TEST(SpacingLaws, WrongPoliciesAreRefused) {
    const auto expect_error = [](const std::string& law, const std::string& part) {
        const std::string error = error_with(law);
        EXPECT_NE(error.find(part), std::string::npos) << error;
    };
    expect_error("law: halved_tim, double_gap: 2 s", "halved_time");
    expect_error("law: halved_time, double_gap: 12 s", "0 s to 10 s");
    expect_error("law: halved_time", "double_gap");
    expect_error("law: constant_time, time_gap: 1 s, double_gap: 2 s", "applies only if law is halved_time");
    expect_error("law: halved_time, double_gap: 1 s", "this test refuses 1 s");
}

TEST(SpacingLaws, AreListed) {
    EXPECT_EQ(gap_law_names().back(), "halved_time");
    EXPECT_NE(describe_fields().find("test: twice the time gap"), std::string::npos);
    EXPECT_EQ(&find_gap_law("halved_time"), &kHalvedTime);
}

}  // namespace
}  // namespace stopline
