// Tests of the table of the paper's statements, one in each row: sections, conditions, numbers, explanations, and the
// functions that judge a row.
#include "reference/targets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "base/io/csv.h"
#include "paper/scorecard.h"
#include "paper/verdict.h"
#include "scenario/scenario_text.h"

namespace stopline {
namespace {

Target of_section(const std::string& section) {
    Target target;
    target.section = section;
    return target;
}

TEST(Section, IncludesOnlyItsSubsections) {
    EXPECT_TRUE(in_section(of_section("III.B"), "III"));
    EXPECT_TRUE(in_section(of_section("III.B"), "III.B"));
    EXPECT_TRUE(in_section(of_section("IV Table 1"), "IV"));
    EXPECT_TRUE(in_section(of_section("IV Table 1"), "IV Table 1"));
    EXPECT_TRUE(in_section(of_section("I"), "I"));
    EXPECT_FALSE(in_section(of_section("III.B"), "I"));
    EXPECT_FALSE(in_section(of_section("III.B"), "II"));
    EXPECT_FALSE(in_section(of_section("IV.C"), "I"));
    EXPECT_FALSE(in_section(of_section("VII.B"), "VI"));
    EXPECT_FALSE(in_section(of_section("VI.B"), "V"));
    EXPECT_FALSE(in_section(of_section("IV.C"), "IV Table 1"));
}

TEST(GreenCondition, HasAPopulationAndAGreenTime) {
    const auto plain = parse_green_condition("CDG green=15");
    ASSERT_TRUE(plain);
    EXPECT_EQ(plain->population, "CDG");
    EXPECT_EQ(plain->green_s, 15.0);
    EXPECT_FALSE(plain->and_above);
    EXPECT_EQ(parse_green_condition("MIX alternating green=15")->population, "MIX");
    const auto above = parse_green_condition("SWITCH-1 green>=20");
    ASSERT_TRUE(above);
    EXPECT_EQ(above->green_s, 20.0);
    EXPECT_TRUE(above->and_above);
    for (const char* other : {"CTG-Ref", "CDG green=", "CDG green=5 left=0 right=0", "CDG green<=10", "green=15",
                              "CDG no turns green=20", ""}) {
        EXPECT_FALSE(parse_green_condition(other)) << other;
    }
}

TEST(Number, MustBeTheWholeText) {
    EXPECT_EQ(parse_number("4.70"), 4.7);
    EXPECT_EQ(parse_number("-20"), -20.0);
    for (const char* other : {"", " 1", "1 ", "1,5", "nan", "inf", "0x10", "1e999", "17 veh"}) {
        EXPECT_FALSE(parse_number(other)) << other;
    }
}

TEST(Targets, ShippedRowsCanBeJudged) {
    const std::vector<Target> targets = load_targets();
    EXPECT_EQ(targets.size(), 136U);
    for (const Target& target : targets) {
        const bool claim = target.kind == "claim";
        EXPECT_NO_THROW(judge(target, claim ? claim_answer(true, "") : number_answer(1.0))) << target.id;
    }
}

TEST(Targets, OwnRowsHaveNoValueOfThePaper) {
    std::set<std::string> ids;
    for (const Target& target : load_targets()) ids.insert(target.id);
    for (const Target& row : load_own_rows()) {
        EXPECT_EQ(row.kind, "own") << row.id;
        EXPECT_EQ(row.value + row.tolerance, "") << row.id;
        EXPECT_EQ(judge(row, number_answer(1.0)), Verdict::own) << row.id;
        EXPECT_TRUE(ids.insert(row.id).second) << row.id << " is also a row of the paper";
    }
}

TEST(Targets, HaveAtMostOneJudgeWithAKnownExperiment) {
    std::set<std::string> ids;
    for (const Target& target : load_targets()) ids.insert(target.id);
    for (const Target& target : load_own_rows()) ids.insert(target.id);
    std::set<std::string> experiment_names;
    for (const Experiment& experiment : experiments()) EXPECT_TRUE(experiment_names.insert(experiment.name).second);
    std::set<std::string> judged;
    for (const RowJudge& judge : row_judges()) {
        EXPECT_TRUE(ids.contains(judge.id)) << judge.id;
        EXPECT_TRUE(judged.insert(judge.id).second) << judge.id << " is judged twice";
        EXPECT_TRUE(experiment_names.contains(judge.experiment)) << judge.experiment;
    }
}

TEST(Targets, RefuseDuplicateIdsAndMissingColumns) {
    const TemporaryFolder folder;
    const std::string header = "id,section,scenario,kind,quantity,condition,value,unit,tolerance,tolerance_kind,note\n";
    const std::string line = "L01,III.E,single_light,target,x,y,1,s,0,abs,\n";
    EXPECT_EQ(load_targets(folder.write("good.csv", header + line)).size(), 1U);
    const auto file = folder.write("bad.csv", header + line + line);
    EXPECT_TRUE(contains(input_error_of([&] { load_targets(file); }), "the id L01 appears twice"));
    const auto lacking = folder.write("lacking.csv", "id,section\nL01,III\n");
    EXPECT_TRUE(contains(input_error_of([&] { load_targets(lacking); }), "no column 'scenario'"));
}

TEST(Explanations, BelongToRowsOfTheScorecard) {
    std::set<std::string> ids;
    for (const Target& target : load_targets()) ids.insert(target.id);
    for (const Target& target : load_own_rows()) ids.insert(target.id);
    std::vector<std::string> warnings;
    for (const auto& [id, explanation] : load_explanations(shipped("data/paper/explanations.csv"), warnings)) {
        EXPECT_TRUE(ids.contains(id)) << id;
        EXPECT_FALSE(explanation.measured_as.empty() && explanation.explanation.empty()) << id;
    }
    EXPECT_TRUE(warnings.empty());
}

TEST(Explanations, AreReadWithTheOldColumnName) {
    const TemporaryFolder folder;
    std::vector<std::string> warnings;
    const std::map<std::string, Explanation> explanations =
        load_explanations(folder.write("explanations.csv", "id,counted,explanation\nL01,how,why\n"), warnings);
    EXPECT_EQ(explanations.at("L01").measured_as, "how");
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_TRUE(contains(warnings.front(), "explanations.csv: column 'counted' is now called 'measured_as'"));
}

TEST(Explanations, AreAddedToTheirRows) {
    const std::map<std::string, Explanation> all{{"L01", {"how it is measured", "cause"}}};
    const auto explained = [&](const std::string& id, Verdict verdict) {
        ScoredRow row;
        row.target.id = id;
        row.verdict = verdict;
        explain(all, row);
        return row;
    };
    EXPECT_EQ(explained("L01", Verdict::inside).measured_as, "how it is measured");
    EXPECT_EQ(explained("L01", Verdict::inside).explanation, "") << "a row inside its tolerance needs no cause";
    EXPECT_EQ(explained("L01", Verdict::miss).explanation, "cause");
    EXPECT_EQ(explained("L02", Verdict::miss).explanation, "Not explained yet.");
    EXPECT_EQ(explained("L02", Verdict::open).explanation, "");
}

}  // namespace
}  // namespace stopline
