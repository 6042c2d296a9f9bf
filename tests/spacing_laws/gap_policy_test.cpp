// Tests of spacing policies: each shipped parameter set against its closed form in the paper, and each registered law
// against the properties that every law must have.
#include "spacing_laws/gap_policy.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "base/input_error.h"
#include "base/random.h"
#include "scenario/load_scenario.h"

namespace stopline {
namespace {

double speed_above(double v_mps, double kmh) { return std::fmax(0.0, v_mps - kmh / 3.6); }

// Net gap in m over speed in m/s, from Section III.C of the paper.
const std::map<std::string, std::function<double(double)>> kClosedForms{
    {"CDG", [](double) { return 2.95; }},
    {"CDG-6m", [](double) { return 6.0; }},
    {"CTG-Ref", [](double v) { return 2.95 + 0.87 * v; }},
    {"HUMAN", [](double v) { return 2.0 + v; }},
    {"CTG-HCM", [](double v) { return 2.95 + 0.92 * v; }},
    {"CTG-HBS", [](double v) { return 2.95 + 1.22 * v; }},
    {"SWITCH-1", [](double v) { return 2.95 + 0.87 * speed_above(v, 30.0); }},
    {"SWITCH-1-6m", [](double v) { return 2.95 + (6.0 - 2.95) * speed_above(v, 30.0) / (20.0 / 3.6); }},
    {"SWITCH-2", [](double v) { return 2.95 + (15.0 - 2.95) * speed_above(v, 30.0) / (20.0 / 3.6); }},
};

struct GapAndSlope {
    double gap_m;
    double slope_s;
};

GapAndSlope evaluate_at(const GapPolicy& policy, double v) {
    GapAndSlope result{};
    policy.evaluate({&v, 1}, {&result.gap_m, 1}, {&result.slope_s, 1});
    return result;
}

TEST(Policies, MatchTheirClosedForm) {
    for (const GapPolicySettings& settings : load_policies()) {
        const auto form = kClosedForms.find(settings.name);
        ASSERT_NE(form, kClosedForms.end()) << "write the closed form of " << settings.name << " into this test";
        const GapPolicy policy = make_gap_policy(settings);
        for (double v = 0.0; v < 40.0; v += 0.01) {
            ASSERT_NEAR(evaluate_at(policy, v).gap_m, form->second(v), 1e-12) << settings.name << " at " << v << " m/s";
            ASSERT_EQ(equilibrium_gap_m(policy, v), evaluate_at(policy, v).gap_m);
        }
    }
}

// Returns random settings in plausible ranges. The gap of the law `formula` has a kink at the switch speed. The gap of
// the law `table` has one 0.5 m/s above it.
std::vector<GapPolicySettings> arbitrary_settings(const std::string& law) {
    std::vector<GapPolicySettings> all;
    for (std::uint64_t k = 0; k < 50; ++k) {
        const auto between = [&](std::uint64_t draw, double low, double high) {
            return low + (high - low) * random_uniform(7, k, draw, Purpose::policy);
        };
        GapPolicySettings s;
        s.law = law;
        s.standstill_gap_m = between(0, 0.5, 8.0);
        const double time_gap_s = between(1, 0.1, 2.5);
        const double switch_speed_mps = between(2, 0.0, 15.0);
        const double reference_speed_mps = switch_speed_mps + between(3, 1.0, 20.0);
        set_law_parameter(s, "time_gap", time_gap_s);
        set_law_parameter(s, "switch_speed", switch_speed_mps);
        set_law_parameter(s, "reference_speed", reference_speed_mps);
        set_law_parameter(s, "reference_gap", s.standstill_gap_m + between(4, 0.0, 30.0));
        s.gap_formula =
            fmt::format("s0 + {} s * max(v - {} m/s, 0 m/s) + 0.01 s2/m * v^2", time_gap_s, switch_speed_mps);
        s.gap_speed_mps = {switch_speed_mps + 0.5, reference_speed_mps + 0.5};
        s.gap_at_speed_m = {s.standstill_gap_m, law_parameter(s, "reference_gap")};
        all.push_back(s);
    }
    return all;
}

TEST(EveryLaw, StartsAtTheStandstillGap) {
    for (const GapLaw* law : gap_laws()) {
        for (const GapPolicySettings& s : arbitrary_settings(law->name)) {
            const GapPolicy policy = make_gap_policy(s);
            EXPECT_EQ(evaluate_at(policy, 0.0).gap_m, s.standstill_gap_m) << law->name;
        }
    }
}

TEST(EveryLaw, NeverDecreasesWithSpeed) {
    for (const GapLaw* law : gap_laws()) {
        for (const GapPolicySettings& s : arbitrary_settings(law->name)) {
            const GapPolicy policy = make_gap_policy(s);
            double previous_m = 0.0;
            for (double v = 0.0; v < 40.0; v += 0.1) {
                const GapAndSlope result = evaluate_at(policy, v);
                ASSERT_GE(result.gap_m, previous_m) << law->name << " at " << v;
                ASSERT_GE(result.slope_s, 0.0) << law->name << " at " << v;
                previous_m = result.gap_m;
            }
        }
    }
}

TEST(EveryLaw, ReturnsItsDerivative) {
    constexpr double kStep = 1e-4;
    for (const GapLaw* law : gap_laws()) {
        for (const GapPolicySettings& s : arbitrary_settings(law->name)) {
            const GapPolicy policy = make_gap_policy(s);
            for (double v = 0.05; v < 40.0; v += 0.1) {
                // A kink may lie at the switch speed. The gap of a law with a table has a kink at each node.
                if (std::fabs(v - law_parameter(s, "switch_speed")) < 2.0 * kStep) continue;
                const double node = v * GapTable::kNodesPerMps;
                if (law->tabulate != nullptr && std::fabs(node - std::round(node)) < 0.01) continue;
                const double derivative =
                    (evaluate_at(policy, v + kStep).gap_m - evaluate_at(policy, v - kStep).gap_m) / (2.0 * kStep);
                ASSERT_NEAR(evaluate_at(policy, v).slope_s, derivative, 1e-6) << law->name << " at " << v;
            }
        }
    }
}

// The gap must not jump at the switch speed, except by rounding.
TEST(EveryLaw, IsContinuousAtTheSwitch) {
    for (const GapLaw* law : gap_laws()) {
        for (const GapPolicySettings& s : arbitrary_settings(law->name)) {
            const GapPolicy policy = make_gap_policy(s);
            const double v = law_parameter(s, "switch_speed");
            const double above_mps = std::nextafter(v, 100.0);
            EXPECT_NEAR(evaluate_at(policy, v).gap_m, evaluate_at(policy, above_mps).gap_m, 1e-9) << law->name;
        }
    }
}

TEST(EveryLaw, EvaluatesSpansLikeSingleValues) {
    const std::vector<double> speeds{0.0, 1.0, 8.3, 8.4, 13.9, 30.0, 0.0, 1e3, 5.0};
    for (const GapPolicySettings& settings : load_policies()) {
        const GapPolicy policy = make_gap_policy(settings);
        std::vector<double> gaps(speeds.size());
        std::vector<double> slopes(speeds.size());
        policy.evaluate(speeds, gaps, slopes);
        for (std::size_t k = 0; k < speeds.size(); ++k) {
            EXPECT_EQ(gaps[k], evaluate_at(policy, speeds[k]).gap_m);
            EXPECT_EQ(slopes[k], evaluate_at(policy, speeds[k]).slope_s);
            EXPECT_TRUE(std::isfinite(gaps[k]) && std::isfinite(slopes[k]));
        }
    }
}

TEST(GapLaws, AreFoundByExactNameOnly) {
    for (const GapLaw* law : gap_laws()) EXPECT_EQ(&find_gap_law(law->name), law);
    try {
        find_gap_law("constant_tim");
        ADD_FAILURE() << "a misspelt name was accepted";
    } catch (const InputError& error) {
        for (const std::string& name : gap_law_names()) {
            EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
        }
    }
}

}  // namespace
}  // namespace stopline
