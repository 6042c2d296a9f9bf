// Tests of judge(), which compares our result (answer) with a statement of the paper (row): tolerances, ranges, claims
// and invalid rows.
#include "paper/verdict.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scenario/scenario_text.h"

namespace stopline {
namespace {

Target row(const std::string& value, const std::string& tolerance, const std::string& tolerance_kind) {
    Target target;
    target.id = "X01";
    target.kind = "target";
    target.value = value;
    target.tolerance = tolerance;
    target.tolerance_kind = tolerance_kind;
    return target;
}

Verdict judged(const Target& target, double ours) { return judge(target, number_answer(ours)); }

TEST(Judge, AbsoluteToleranceIncludesItsLimits) {
    const Target target = row("17", "1", "abs");
    for (const double ours : {16.0, 16.5, 17.0, 18.0}) EXPECT_EQ(judged(target, ours), Verdict::inside) << ours;
    for (const double ours : {15.0, 15.999, 18.001, -17.0}) EXPECT_EQ(judged(target, ours), Verdict::miss) << ours;
}

TEST(Judge, PercentToleranceRefersToTheValueOfThePaper) {
    const Target target = row("5254", "6", "%");
    EXPECT_EQ(judged(target, 5254 * 1.06), Verdict::inside);
    EXPECT_EQ(judged(target, 5254 * 1.061), Verdict::miss);
    EXPECT_EQ(judged(target, 5254 * 0.939), Verdict::miss);
    EXPECT_EQ(judged(row("-20", "10", "%"), -22.0), Verdict::inside);  // the tolerance refers to the magnitude
    EXPECT_EQ(judged(row("-20", "10", "%"), -22.1), Verdict::miss);
}

TEST(Judge, MaximumHasNoLowerLimit) {
    const Target target = row("1.0", "", "max");
    EXPECT_EQ(judged(target, 0.0), Verdict::inside);
    EXPECT_EQ(judged(target, 1.0), Verdict::inside);
    EXPECT_EQ(judged(target, 1.001), Verdict::miss);
}

TEST(Judge, ZeroToleranceAllowsOnlyRounding) {
    const Target target = row("0.87", "0", "abs");
    EXPECT_EQ(judged(target, 0.87), Verdict::inside);
    EXPECT_EQ(judged(target, 87.0 / 100.0 * (1.0 + 1e-15)), Verdict::inside);
    EXPECT_EQ(judged(target, 0.870001), Verdict::miss);
}

// An input of the paper is no result, so an equal value does not count as agreement.
TEST(Judge, InputsAreNoResults) {
    Target target = row("0.87", "0", "abs");
    target.kind = "input";
    EXPECT_EQ(judged(target, 0.87), Verdict::input);
    EXPECT_EQ(judged(target, 0.88), Verdict::miss);
}

TEST(Judge, RangeAcceptsNumbersWithinAndRangesWithItsEnds) {
    const Target target = row("20..45", "8", "abs");
    EXPECT_EQ(judged(target, 30.0), Verdict::inside);
    EXPECT_EQ(judged(target, 12.0), Verdict::inside);
    EXPECT_EQ(judged(target, 53.0), Verdict::inside);
    EXPECT_EQ(judged(target, 11.9), Verdict::miss);
    EXPECT_EQ(judged(target, 53.1), Verdict::miss);
    EXPECT_EQ(judge(target, range_answer(15.0, 50.0)), Verdict::inside);
    EXPECT_EQ(judge(target, range_answer(15.0, 54.0)), Verdict::miss);
    EXPECT_EQ(judge(target, range_answer(30.0, 32.0)),
              Verdict::miss);  // our range does not reach the ends of the paper's range
}

TEST(Judge, ClaimsHoldOrNot) {
    Target claim = row("A > B", "", "");
    claim.kind = "claim";
    EXPECT_EQ(judge(claim, claim_answer(true, "A 2, B 1")), Verdict::inside);
    EXPECT_EQ(judge(claim, claim_answer(false, "A 1, B 2")), Verdict::miss);
    EXPECT_EQ(judge(claim, std::nullopt), Verdict::open);
    EXPECT_TRUE(contains(input_error_of([&] { judge(claim, number_answer(1.0)); }), "X01"));
}

TEST(Judge, UnmeasuredValuesAreOpenAndMissingResultsAreAMiss) {
    EXPECT_EQ(judge(row("17", "1", "abs"), std::nullopt), Verdict::open);
    EXPECT_EQ(judged(row("17", "1", "abs"), std::nan("")), Verdict::miss);
    EXPECT_EQ(judged(row("17", "1", "max"), std::nan("")), Verdict::miss);
    EXPECT_EQ(number_answer(std::nan("")).text, "none");
    EXPECT_EQ(judged(row("4.70", "", ""), 4.7), Verdict::open);  // the row states no tolerance
}

TEST(Judge, RefusesInvalidRows) {
    const auto error = [](const Target& target) { return input_error_of([&] { judged(target, 1.0); }); };
    EXPECT_TRUE(contains(error(row("many", "1", "abs")), "value 'many'"));
    EXPECT_TRUE(contains(error(row("1..2..3", "1", "abs")), "value '1..2..3'"));
    EXPECT_TRUE(contains(error(row("45..20", "1", "abs")), "value '45..20'"));
    EXPECT_TRUE(contains(error(row("1", "some", "abs")), "tolerance 'some'"));
    EXPECT_TRUE(contains(error(row("1", "-1", "abs")), "tolerance '-1'"));
    EXPECT_TRUE(contains(error(row("1", "1", "about")), "unknown kind of tolerance 'about'"));
}

TEST(ToleranceText, IsReadable) {
    EXPECT_EQ(tolerance_text(row("17", "1", "abs")), "±1");
    EXPECT_EQ(tolerance_text(row("17", "6", "%")), "±6 %");
    EXPECT_EQ(tolerance_text(row("17", "0", "abs")), "exact");
    EXPECT_EQ(tolerance_text(row("17", "", "max")), "max");
    EXPECT_EQ(tolerance_text(row("17", "", "")), "");
}

}  // namespace
}  // namespace stopline
