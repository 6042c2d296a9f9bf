// Tests of the results page and its headlines with made-up rows, and of the results page in the repository.
#include "paper/results_page.h"

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>

#include "base/io/data_directory.h"
#include "base/io/escape.h"
#include "paper/headlines.h"
#include "reference/targets.h"
#include "scenario/scenario_text.h"

namespace stopline {
namespace {

ScoredRow row_of(const std::string& id, const std::string& section, const std::string& ours, Verdict verdict) {
    ScoredRow row;
    row.target.id = id;
    row.target.section = section;
    row.target.quantity = "improvement_over_ctg_ref";
    row.target.condition = "CDG no_turns | mean";
    row.target.value = "50";
    row.target.unit = "%";
    row.target.tolerance = "12";
    row.target.tolerance_kind = "abs";
    row.ours = ours;
    row.verdict = verdict;
    return row;
}

Scorecard example_scorecard() {
    Scorecard scorecard;
    scorecard.rows = {row_of("B04", "VII.C", "61.2", Verdict::inside), row_of("B05", "I", "", Verdict::open),
                      row_of("A05", "VI.B", "80", Verdict::miss)};
    scorecard.rows[2].explanation = "See <A11>.";
    return scorecard;
}

TEST(Headlines, AreFiveAndNameMissingValues) {
    const std::vector<Headline> lines = headlines(example_scorecard());
    ASSERT_EQ(lines.size(), 5u);
    EXPECT_EQ(lines[0].text, "Not measured in these runs: vehicles in 15 s of green, gain with long greens.");
    EXPECT_EQ(
        lines[2].text,
        "CDG gains 80 % on the arterial without turns from the major street. It gains 61 % in Berlin. Not measured in "
        "these runs: grid.");
    EXPECT_EQ(lines[4].text, "Of 3 rows with results 1 are inside their tolerance, 1 outside, and 1 open.");
}

TEST(Headlines, TreatAnAnswerWithoutNumberAsMissing) {
    Scorecard scorecard = example_scorecard();
    scorecard.rows[0].ours = "none";
    EXPECT_TRUE(contains(headlines(scorecard)[2].text, "grid, Berlin."));
}

TEST(ResultsPage, HasATablePerSectionAndTheFindingsAtTheEnd) {
    const std::string page =
        results_markdown(example_scorecard(), "stopline-scorecard --markdown x.md", "## Findings\n");
    EXPECT_TRUE(contains(page, "`stopline-scorecard --markdown x.md`"));
    const std::size_t introduction = page.find("## Section I: numbers of the introduction");
    EXPECT_LT(introduction, page.find("## Section VII: Berlin"));
    EXPECT_TRUE(contains(page,
                         "| A05 | improvement over CTG-Ref | CDG no_turns \\| mean | 50 | 80 | % | +30 | ±12 | "
                         "**outside** | See \\<A11>. |"));
    EXPECT_TRUE(contains(page, "| All | 3 | 1 | 1 | 1 | 0 |"));
    EXPECT_TRUE(page.ends_with("\n## Findings\n"));
}

// Returns the table rows with ten columns in data/paper/RESULTS.md. The key of a row is the text of its first column.
std::map<std::string, std::vector<std::string>> rows_of_committed_page() {
    std::ifstream file(data_directory() / "paper" / "RESULTS.md");
    std::map<std::string, std::vector<std::string>> rows;
    for (std::string line; std::getline(file, line);) {
        std::vector<std::string> cells;
        std::istringstream text(line);
        for (std::string cell; std::getline(text, cell, '|');) {
            if (!cells.empty() && cells.back().ends_with('\\')) {
                cells.back() += "|" + cell;  // an escaped bar does not end the cell
            } else {
                cells.push_back(cell);
            }
        }
        constexpr std::size_t kCells = 11;  // ten columns, after the empty text before the first bar
        if (cells.size() == kCells) rows[cells[1]] = cells;
    }
    return rows;
}

TEST(ResultsPage, InTheRepositoryHasEachRowOfThePaperWithItsCause) {
    const auto rows = rows_of_committed_page();
    std::vector<Target> targets = load_targets();
    const std::vector<Target> own = load_own_rows();
    targets.insert(targets.end(), own.begin(), own.end());
    int outside = 0;
    for (const Target& target : targets) {
        const auto row = rows.find(" " + target.id + " ");
        ASSERT_NE(row, rows.end()) << target.id << ": stopline-scorecard --markdown data/paper/RESULTS.md";
        const std::vector<std::string>& cells = row->second;
        EXPECT_EQ(cells[4], " " + escape_markdown_cell(target.value) + " ") << target.id;
        if (cells[9] != " **outside** ") continue;
        ++outside;
        EXPECT_NE(cells[10], " Not explained yet. ") << target.id;
    }
    EXPECT_GT(outside, 0);
    EXPECT_GE(targets.size(), 100U);
}

}  // namespace
}  // namespace stopline
