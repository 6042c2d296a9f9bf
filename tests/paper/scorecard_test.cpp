// Tests of the scorecard, which compares our results (answers) with the statements of the paper (rows): answers,
// verdicts by section, stored measurements and the commands that give the answers.
#include "paper/scorecard.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "base/io/csv.h"
#include "paper/headlines.h"
#include "runs/interrupted.h"
#include "scenario/scenario_text.h"

namespace stopline {
namespace {

std::optional<Answer> answer_of(const std::string& id, const Measurements& measured) {
    std::vector<Target> targets = load_targets();
    const std::vector<Target> own = load_own_rows();
    targets.insert(targets.end(), own.begin(), own.end());
    const auto target = std::find_if(targets.begin(), targets.end(), [&](const Target& t) { return t.id == id; });
    for (const RowJudge& judge : row_judges()) {
        if (judge.id == id) return judge.answer(*target, measured);
    }
    return std::nullopt;
}

TEST(SectionThree, ReadsEachAnswerFromItsOwnMeasurement) {
    Measurements measured;
    measured.set("passed CDG 15", 17);
    measured.set("passed CDG 30", 43);
    measured.set("passed MIX 15", 11);
    measured.set("improvement CDG 10", 125);
    measured.set("improvement_from CDG 10", 1);
    measured.set("improvement_from CDG 30", 142);
    measured.set("improvement CDG 30", 139);
    measured.set("steady_gap CTG-Ref", 15.03);
    measured.set("speed_limit_kmh", 50);
    EXPECT_EQ(answer_of("L01", measured)->low, 17);
    EXPECT_EQ(answer_of("L07", measured)->low, 43);
    EXPECT_EQ(answer_of("L04", measured)->low, 11);
    EXPECT_EQ(answer_of("L08", measured)->low, 125);
    EXPECT_EQ(answer_of("L09", measured)->low, 142);
    EXPECT_EQ(answer_of("L14", measured)->low, 15.03);
    EXPECT_FALSE(answer_of("L02", measured)) << "SWITCH-1 was not measured";
    measured.set("speed_limit_kmh", 30);
    EXPECT_FALSE(answer_of("L14", measured)) << "the row is about 50 km/h";
}

TEST(SectionThree, UsesTheWorstPopulationForRowsAboutAll) {
    Measurements measured;
    measured.set("leader_to_limit CDG", 15.1);
    measured.set("leader_to_limit MIX", 12.9);
    measured.set("leader_to_limit CTG-Ref", 16.0);
    EXPECT_EQ(answer_of("L13", measured)->low, 12.9);
    measured.set("standstill_gap CDG", 2.95);
    measured.set("standstill_gap CDG-6m", 6);
    measured.set("standstill_gap CTG-Ref", 2.9);
    EXPECT_EQ(answer_of("P02", measured)->low, 2.9);
}

// Returns measured counts of vehicles that pass the stop line within 15 s. The fractional part of a count shows how
// near the next vehicle is to the line.
Measurements counts(double cdg, double switch_1, double switch_2, double mix, double ref, double hbs) {
    Measurements measured;
    const std::vector<std::pair<const char*, double>> all{{"CDG", cdg}, {"SWITCH-1", switch_1}, {"SWITCH-2", switch_2},
                                                          {"MIX", mix}, {"CTG-Ref", ref},       {"CTG-HBS", hbs}};
    for (const auto& [name, counter] : all) {
        measured.set(std::string("passed ") + name + " 15", std::floor(counter));
        measured.set(std::string("counter ") + name + " 15", counter);
    }
    return measured;
}

TEST(SectionThree, OrderDependsOnCountsThenOnTheNextVehicle) {
    EXPECT_TRUE(*answer_of("L15", counts(17.2, 13.5, 13.1, 11.0, 8.2, 7.9))->holds);
    EXPECT_TRUE(*answer_of("L15", counts(17.2, 13.5, 13.1, 11.0, 8.9, 8.1))->holds);
    EXPECT_TRUE(*answer_of("L15", counts(17.2, 14.9, 13.1, 11.0, 8.2, 7.9))->holds) << "one vehicle counts as equal";
    EXPECT_FALSE(*answer_of("L15", counts(17.2, 15.0, 13.1, 11.0, 8.2, 7.9))->holds);
    EXPECT_FALSE(*answer_of("L15", counts(17.2, 13.5, 13.1, 11.0, 8.1, 8.2))->holds);
    EXPECT_FALSE(*answer_of("L15", counts(13.0, 13.5, 13.1, 11.0, 8.2, 7.9))->holds);
    EXPECT_EQ(answer_of("L15", counts(17.2, 13.5, 13.1, 11.0, 8.2, 7.9))->text,
              "CDG 17, SWITCH-1 13, SWITCH-2 13, MIX 11, CTG-Ref 8, CTG-HBS 7");
    EXPECT_FALSE(answer_of("L15", Measurements{}));
}

// Rows K01 to K15 read the values of the right runs. Every measured value is different.
TEST(Coordination, RowsCompareTheRunsThatTheyName) {
    Measurements measured;
    measured.set("throughput_veh_h without 15 CTG-Ref", 1000);
    measured.set("throughput_veh_h without 15 CDG", 1100);
    measured.set("throughput_veh_h with 15 CTG-Ref", 500);
    measured.set("throughput_veh_h with 15 CDG", 800);
    EXPECT_NEAR(answer_of("K01", measured)->low, 10.0, 1e-9);
    EXPECT_NEAR(answer_of("K02", measured)->low, 60.0, 1e-9);
    EXPECT_FALSE(answer_of("K04", measured)) << "the runs with 20 s of green are missing";
    for (const auto& [runs, blocking_h] : {std::pair{"without 15 CDG", 30.0}, std::pair{"with 15 CDG", 1.0}}) {
        measured.set(std::string("delay_junction_blocking_h ") + runs, blocking_h);
        measured.set(std::string("delay_turn_blocking_h ") + runs, 2.0 * blocking_h);
        measured.set(std::string("delay_gridlock_h ") + runs, blocking_h);
    }
    EXPECT_NEAR(answer_of("K08", measured)->low, 100.0 * 4.0 / 120.0, 1e-9);
    EXPECT_FALSE(answer_of("K06", measured)) << "the runs with 10 s and 20 s are missing";
    for (const char* const runs : {"with 10 CDG", "with 15 CDG", "with 20 CDG"}) {
        measured.set(std::string("gridlocks ") + runs, 2.0);
    }
    EXPECT_EQ(answer_of("K06", measured)->low, 6.0);
    measured.set("delay_wrong_lane_h without CDG", 80.0);
    measured.set("delay_wrong_lane_h with CDG", 20.0);
    EXPECT_NEAR(answer_of("K15", measured)->low, 25.0, 1e-9);
}

// Rows E01 to E13.
TEST(Energy, RowsCompareTheRunsThatTheyName) {
    Measurements measured;
    measured.set("fuel_g_per_km 0 CTG-Ref", 100);
    measured.set("fuel_g_per_km 0 CDG", 80);
    measured.set("fuel_g_per_km 15 CTG-Ref", 200);
    measured.set("fuel_g_per_km 15 CDG", 150);
    measured.set("hcm_control_delay_s 0 CDG", 30);
    EXPECT_EQ(answer_of("E01", measured)->low, 100.0);
    EXPECT_EQ(answer_of("E02", measured)->low, 80.0);
    EXPECT_NEAR(answer_of("E03", measured)->low, -20.0, 1e-9);
    EXPECT_EQ(answer_of("E05", measured)->low, 30.0);
    EXPECT_NEAR(answer_of("E06", measured)->low, -25.0, 1e-9);
    EXPECT_FALSE(answer_of("E04", measured));
    EXPECT_FALSE(answer_of("E12", measured));
}

TEST(OwnRows, AreNoResultsOfThePaper) {
    std::size_t rows = 0;
    for (const char* const section : {"coordination", "energy"}) {
        const Scorecard scorecard = score(section, {});
        const std::size_t own = scorecard.rows.size();
        rows += own;
        EXPECT_EQ(scorecard.count(Verdict::own), static_cast<int>(own));
        EXPECT_EQ(scorecard.count(Verdict::open), 0);
        EXPECT_TRUE(contains(results_text(scorecard), "0 rows with results")) << results_text(scorecard);
        EXPECT_TRUE(contains(results_text(scorecard), std::to_string(own) + " further rows hold results of our own."));
        for (const ScoredRow& row : scorecard.rows) {
            EXPECT_FALSE(row.measured_as.empty()) << row.target.id << " is missing in explanations.csv";
            EXPECT_TRUE(std::any_of(row_judges().begin(), row_judges().end(), [&](const RowJudge& judge) {
                return judge.id == row.target.id;
            })) << row.target.id;
        }
    }
    EXPECT_EQ(rows, load_own_rows().size());
}

TEST(Scorecard, JudgesInputsWithoutMeasuring) {
    const TemporaryFolder folder;
    ScorecardOptions options;
    options.section = "III.B";
    options.folder = folder.path();
    const Scorecard scorecard = make_scorecard(options);
    ASSERT_EQ(scorecard.rows.size(), 3U);
    EXPECT_EQ(scorecard.count(Verdict::input), 3) << "inputs are no results";
    EXPECT_EQ(scorecard.count(Verdict::inside), 0);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Scorecard, RowsWithoutToleranceAreOpen) {
    const TemporaryFolder folder;
    ScorecardOptions options;
    options.section = "V.A";
    options.folder = folder.path();
    const Scorecard scorecard = make_scorecard(options);
    EXPECT_EQ(scorecard.rows.size(), 10U);
    EXPECT_EQ(scorecard.count(Verdict::open), 10);
    const CsvTable csv = parse_csv(scorecard_csv(scorecard), "scorecard");
    EXPECT_EQ(csv.columns, (std::vector<std::string>{"id", "section", "paper", "ours", "unit", "tolerance", "verdict",
                                                     "explanation"}));
    EXPECT_EQ(csv.rows.size(), scorecard.rows.size());
}

TEST(Scorecard, ReusesMeasurementsOfTheSameScenario) {
    const TemporaryFolder folder;
    std::vector<std::string> messages;
    ScorecardOptions options;
    options.section = "III.E";
    options.folder = folder.path();
    options.threads = 2;
    options.on_message = [&](const std::string& message) { messages.push_back(message); };
    const std::string first = scorecard_csv(make_scorecard(options));
    const std::string second = scorecard_csv(make_scorecard(options));
    EXPECT_EQ(first, second);
    options.settings = {"seed=2"};
    make_scorecard(options);
    ASSERT_EQ(messages.size(), 3U);
    EXPECT_TRUE(contains(messages[0], "running"));
    EXPECT_TRUE(contains(messages[1], "already measured"));
    EXPECT_TRUE(contains(messages[2], "running")) << "another seed is another scenario";
}

class ScorecardInterrupt : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Sections, ScorecardInterrupt, testing::Values("III", "IV"));

TEST_P(ScorecardInterrupt, StoresNoMeasurements) {
    const TemporaryFolder folder;
    ScorecardOptions options;
    options.section = GetParam();
    options.folder = folder.path();
    options.threads = 2;
    options.on_progress = [](double /*share*/) { return false; };
    EXPECT_THROW(make_scorecard(options), Interrupted);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path() / "measured"));
}

TEST(Scorecard, RefusesAnUnknownSection) {
    ScorecardOptions options;
    options.section = "XI";
    const std::string error = input_error_of([&] { make_scorecard(options); });
    EXPECT_TRUE(contains(error, "no rows of section 'XI'; sections with rows: III.B"));
}

// Every section has a command. If the command names a scenario file, this file exists.
TEST(Scorecard, NamesTheCommandsOfASection) {
    const auto commands = [](const std::string& section) { return commands_behind(score(section, {}).rows); };
    using Commands = std::vector<std::string>;
    EXPECT_EQ(commands("III"), Commands{"stopline-run scenarios/single_light.yaml"});
    EXPECT_EQ(commands("IV"), Commands{"stopline-sweep scenarios/sweeps/intersection.yaml"});
    EXPECT_EQ(commands("V"), Commands{"stopline-calibrate"});
    EXPECT_EQ(commands("VI.C"), Commands{"stopline-sweep scenarios/sweeps/grid.yaml"});
    EXPECT_EQ(commands("VII"), Commands{"stopline-sweep scenarios/sweeps/berlin.yaml"});
    EXPECT_EQ(commands("I"), commands("VII"));
    EXPECT_EQ(commands("coordination").size(), 2U);
    EXPECT_EQ(commands("energy").size(), 2U);
    EXPECT_EQ(commands("").size(), 11U);
    for (const std::string& command : commands("")) {
        const std::size_t file = command.find("scenarios/");
        if (file == std::string::npos) continue;
        EXPECT_TRUE(std::filesystem::exists(std::filesystem::path(STOPLINE_SOURCE_DIR) / command.substr(file)))
            << command;
    }
}

}  // namespace
}  // namespace stopline
