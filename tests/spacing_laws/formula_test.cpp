// Tests of formulas for gaps: values, precedence, units, and errors that point at the wrong part of a formula.
#include "spacing_laws/formula.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "spacing_laws/gap_policy.h"

namespace stopline {
namespace {

constexpr double kStandstill_m = 3.0;

double value_of(const std::string& text, double speed_mps) {
    GapFormula::Error error;
    const GapFormula formula = GapFormula::parse(text, error);
    EXPECT_EQ(error.message, "") << text;
    return error.message.empty() ? formula.gap_m(kStandstill_m, speed_mps) : std::numeric_limits<double>::quiet_NaN();
}

TEST(GapFormula, EvaluatesAsWritten) {
    const double v = 8.0;
    EXPECT_DOUBLE_EQ(value_of("s0", v), 3.0);
    EXPECT_DOUBLE_EQ(value_of("s0 + 0.4 s * v + 0.01 s2/m * v^2", v), 3.0 + 0.4 * 8.0 + 0.01 * 64.0);
    EXPECT_DOUBLE_EQ(value_of("10 m - 2 m - 1 m", v), 7.0);  // from the left
    EXPECT_DOUBLE_EQ(value_of("12 m / 2 / 3", v), 2.0);      // from the left
    EXPECT_DOUBLE_EQ(value_of("1 m + 2 * 3 m", v), 7.0);     // product before sum
    EXPECT_DOUBLE_EQ(value_of("(1 + 2) * 3 m", v), 9.0);
    EXPECT_DOUBLE_EQ(value_of("10 m + -2 * 3 m", v), 4.0);
    EXPECT_DOUBLE_EQ(value_of("10 m - 0.125 s2/m * -v^2", v), 18.0);  // power before sign
    EXPECT_DOUBLE_EQ(value_of("min(s0, 2 m, 5 m)", v), 2.0);
    EXPECT_DOUBLE_EQ(value_of("max(s0, 1 s * v)", v), 8.0);
    EXPECT_DOUBLE_EQ(value_of("sqrt(16 m^2)", v), 4.0);
    EXPECT_DOUBLE_EQ(value_of("v^2 / (2 * 4 m/s2)", v), 8.0);
    EXPECT_DOUBLE_EQ(value_of("s0*v/(1 m/s)*v^0", v), 24.0);
}

TEST(GapFormula, ReadsUnits) {
    EXPECT_DOUBLE_EQ(value_of("0.002 km", 0.0), 2.0);
    EXPECT_DOUBLE_EQ(value_of("500 ms * 36 km/h", 0.0), 5.0);
    EXPECT_DOUBLE_EQ(value_of("2 m/s2 * 3 s^2", 0.0), 6.0);
    EXPECT_DOUBLE_EQ(value_of("2 m / s0 * 1 m", 0.0), 2.0 / 3.0);  // s0 is no unit
    EXPECT_DOUBLE_EQ(value_of("sqrt(2 m2^2) / 1 m", 0.0), 2.0);    // the power of a number with a unit
}

TEST(GapFormula, RefusesUnitsWithAnIncompleteOrHugeExponent) {
    GapFormula::Error error;
    GapFormula::parse("4 h4^", error);
    EXPECT_EQ(error.message, "an exponent is a whole number from 0 to 9");
    std::string text = "v";
    for (int k = 0; k < 40; ++k) text = "(" + text + ")^9";
    GapFormula::parse(text, error);
    EXPECT_EQ(error.message, "m729/s729 has an exponent above 100");
}

TEST(GapFormula, ComparesInIf) {
    const std::string at_8 = "if(v OP 8 m/s, 1 m, 2 m)";
    const auto with = [&](const std::string& comparison, double v) {
        std::string text = at_8;
        text.replace(text.find("OP"), 2, comparison);
        return value_of(text, v);
    };
    EXPECT_EQ(with("<", 8.0), 2.0);
    EXPECT_EQ(with("<=", 8.0), 1.0);
    EXPECT_EQ(with(">", 8.0), 2.0);
    EXPECT_EQ(with(">=", 8.0), 1.0);
    EXPECT_EQ(with("<", 7.9), 1.0);
    EXPECT_EQ(with(">", 8.1), 1.0);
}

struct WrongFormula {
    std::string text;
    std::string part;     // the error must point at the first character of this part
    std::string message;  // and contain this text
};

TEST(GapFormula, NamesTheWrongPart) {
    const std::vector<WrongFormula> all{
        {"s0 + 0.4 m * v", "0.4 m * v", "'0.4 m * v' has the unit m2/s, but 's0' has the unit m"},
        {"0.4 * v", "0.4 * v", "the formula has the unit m/s, but a gap has the unit m"},
        {"5", "5", "the formula has no unit"},
        {"s0 + 2 m v", "v", "'v' is not expected here"},
        {"s0 + 0.5 s v", "v", "'v' is not expected here; write * between factors"},
        {"s0 + 30 % * v", "% * v", "'% * v' is not expected here"},
        {"s0 + 2 v", "v", "'v' is not a unit"},
        {"s0 + speed", "speed", "there is no 'speed'"},
        {"s0 + 2 ft", "ft", "'ft' is not a unit"},
        {"s0 + (2 m", "", "')' is missing at the end"},
        {"s0 +", "", "a value is missing at the end"},
        {"s0 ** 2", "* 2", "'* 2' is not a value"},
        {"min(s0, v)", "v)", "'v' has the unit m/s, but 's0' has the unit m"},
        {"if(v, s0, s0)", ", s0, s0)", "if needs a comparison"},
        {"if(v < 3 m, s0, s0)", "3 m, s0, s0)", "only values of the same unit can be added, subtracted or compared"},
        {"s0^1.5", "1.5", "an exponent is a whole number from 0 to 9"},
        {"sqrt(s0)", "s0)", "whose root is not a unit"},
        {"", "", "a value is missing at the end"},
        {std::string(100, '('), "", "parentheses are nested more than 50 deep"},
        {std::string(2000, '1'), std::string(2000, '1'), "at most 1000 characters"},
    };
    for (const WrongFormula& wrong : all) {
        GapFormula::Error error;
        GapFormula::parse(wrong.text, error);
        EXPECT_NE(error.message.find(wrong.message), std::string::npos) << wrong.text << ": " << error.message;
        if (wrong.part.empty()) continue;
        EXPECT_EQ(wrong.text.substr(error.position), wrong.part) << error.message;
    }
}

GapPolicySettings formula_policy(const std::string& formula) {
    GapPolicySettings settings;
    settings.law = "formula";
    settings.standstill_gap_m = kStandstill_m;
    settings.gap_formula = formula;
    return settings;
}

TEST(FormulaLaw, KeepsTheFormula) {
    const GapPolicy policy = make_gap_policy(formula_policy("s0 + 0.4 s * v + 0.01 s2/m * v^2"));
    for (double v = 0.0; v < 60.0; v += 0.37) {
        EXPECT_NEAR(equilibrium_gap_m(policy, v), 3.0 + 0.4 * v + 0.01 * v * v, 2e-6) << v;
    }
}

TEST(FormulaLaw, RefusesGapsThatVehiclesCannotKeep) {
    const auto problem_of = [](const std::string& formula) {
        const std::vector<LawProblem> problems = find_gap_law("formula").problems(formula_policy(formula));
        return problems.empty() ? std::string() : problems[0].message;
    };
    const auto expect = [&](const std::string& formula, const std::string& message) {
        EXPECT_NE(problem_of(formula).find(message), std::string::npos) << formula << ": " << problem_of(formula);
    };
    EXPECT_EQ(problem_of("s0 + 0.9 s * v"), "");
    expect("2 m + 0.9 s * v", "the gap at rest is 2 m, but standstill_gap is 3 m");
    expect("s0 + 1 s * v - 0.05 s2/m * v^2", "the gap falls near 36");
    expect("if(v < 10 m/s, s0, 15 m)", "it may not jump");
    expect("s0 / (v / (20 m/s) - 1)^0 + 0 m / (v - 20 m/s) * 1 m/s", "is not a finite number");
    expect("s0 + 0.9 m * v", "character 6");
    expect("s0 + 0.3 m * if(v > 30 km/h, 1, 0)", "it may not jump");
    expect("max(s0, sqrt(0 m^2 - s0 * v * 1 s))", "is not a finite number");
    expect("max(sqrt(0 m^2 - s0 * v * 1 s), s0)", "is not a finite number");
}

TEST(TableLaw, IsLinearBetweenItsPoints) {
    GapPolicySettings settings;
    settings.law = "table";
    settings.standstill_gap_m = 2.0;
    settings.gap_speed_mps = {10.0, 20.0};
    settings.gap_at_speed_m = {4.0, 14.0};
    const GapPolicy policy = make_gap_policy(settings);
    EXPECT_EQ(equilibrium_gap_m(policy, 0.0), 2.0);
    EXPECT_NEAR(equilibrium_gap_m(policy, 5.0), 3.0, 1e-9);
    EXPECT_NEAR(equilibrium_gap_m(policy, 10.0), 4.0, 1e-9);
    EXPECT_NEAR(equilibrium_gap_m(policy, 16.0), 10.0, 1e-9);
    EXPECT_NEAR(equilibrium_gap_m(policy, 120.0), 114.0, 1e-6);  // continues with the last slope
    settings.gap_at_speed_m = {4.0, 3.0};
    EXPECT_NE(find_gap_law("table").problems(settings)[0].message.find("the gap falls"), std::string::npos);
}

// A formula with a constant time gap gets the same mesoscale model as the law constant_time.
TEST(FormulaLaw, NamesItsMesoscaleModel) {
    GapPolicySettings formula = formula_policy("s0 + 0.87 s * v");
    formula.mesoscale = "time_gap";
    GapPolicySettings constant_time = formula;
    constant_time.law = "constant_time";
    set_law_parameter(constant_time, "time_gap", 0.87);
    const MesoGap a = make_gap_policy(formula).meso;
    const MesoGap b = make_gap_policy(constant_time).meso;
    EXPECT_EQ(a.family, b.family);
    EXPECT_NEAR(a.time_gap_s, b.time_gap_s, 1e-9);
    EXPECT_TRUE(a.has_extra_gap);
    EXPECT_FALSE(b.has_extra_gap);
    formula.mesoscale = "constant_distance";
    EXPECT_EQ(make_gap_policy(formula).meso.family, kConstantDistanceFamily);
    formula.mesoscale = kFamilyByLaw;
    EXPECT_EQ(make_gap_policy(formula).meso.family, "") << "a formula implies no model";
}

// A policy can name another model than that of its law. The desired gap stays that of the law at every speed.
TEST(MesoGap, KeepsTheGapOfTheLawWithEveryModel) {
    GapPolicySettings settings;
    settings.law = "constant_time";
    set_law_parameter(settings, "time_gap", 0.87);
    for (const char* const family : {kFamilyByLaw, kTimeGapFamily, kConstantDistanceFamily, "idm"}) {
        settings.mesoscale = family;
        const MesoGap gap = make_gap_policy(settings).meso;
        if (settings.mesoscale != kFamilyByLaw) {
            EXPECT_EQ(gap.family, family);
        }
        EXPECT_EQ(gap.has_extra_gap, gap.family == kConstantDistanceFamily) << family;
        EXPECT_EQ(gap.time_gap_s, gap.has_extra_gap ? 0.0 : 0.87) << family;
    }
}

}  // namespace
}  // namespace stopline
