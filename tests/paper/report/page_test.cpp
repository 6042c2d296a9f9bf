// The page of the report, from made-up content.
#include <gtest/gtest.h>

#include "paper/report/job_writer.h"
#include "paper/report/report.h"
#include "runs/metrics/metric_groups.h"
#include "scenario/scenario_text.h"

namespace stopline {
namespace {

ScoredRow row_of(const std::string& id, const std::string& section, const std::string& paper, const std::string& ours,
                 Verdict verdict) {
    ScoredRow row;
    row.target.id = id;
    row.target.section = section;
    row.target.quantity = "vehicles_passed";
    row.target.value = paper;
    row.target.unit = "veh";
    row.target.tolerance = "1";
    row.target.tolerance_kind = "abs";
    row.ours = ours;
    row.verdict = verdict;
    return row;
}

ReportContent example_content() {
    ReportContent content;
    content.section = "III";
    content.command = "stopline-reproduce --section III";
    content.version = "1.2.3 <&>";
    content.machine = "a machine";
    content.seeds = "1 to 6";
    content.scorecard.rows = {row_of("L01", "III.E", "20", "17", Verdict::miss),
                              row_of("L02", "III.E", "8", "8", Verdict::inside)};
    content.scorecard.rows[0].explanation = "because a < b";
    ShownFigure shown;
    shown.listed = {"Fig. 5", "III.E", "single_light", "counters", "Vehicles & lines", "Words <b>"};
    shown.picture = "data:image/svg+xml;base64,AAAA";
    shown.seeds = "1";
    shown.commands = {"stopline-run 'a b'"};
    content.figures = {shown};
    shown.listed = {"Fig. 3", "III.D", "", "", "A drawing", "No numbers."};
    content.figures.push_back(shown);
    content.tables = {"scorecard.csv"};
    return content;
}

bool has(const std::string& page, const std::string& text) { return page.find(text) != std::string::npos; }

TEST(ReportPage, HasTheScorecardBeforeTheFigures) {
    const std::string page = report_page(example_content());
    EXPECT_LT(page.find("Rows met"), page.find("<figure"));
    EXPECT_LT(page.find("id=\"row-L01\""), page.find("<figure"));
    EXPECT_TRUE(has(page, "data-label=\"Difference\">-3 (-15.0 %)</td>"));
    EXPECT_TRUE(has(page, "data-label=\"Difference\">0</td>"));
    EXPECT_TRUE(has(page, "✗ outside"));
    EXPECT_TRUE(has(page, "✓ inside"));
    EXPECT_TRUE(has(page, "because a &lt; b"));
}

// The page starts with five lines derived from the rows of the scorecard, followed by the main pictures.
TEST(ReportPage, StartsWithTheAnswer) {
    ReportContent content = example_content();
    content.scorecard.rows[0].ours = "17";
    content.scorecard.rows.push_back(row_of("L05", "III.E", "8", "7", Verdict::inside));
    const std::string page = report_page(content);
    const std::size_t answer = page.find("id=\"answer\"");
    const std::size_t lines_end = page.find("</ul>", answer);
    EXPECT_LT(answer, page.find("<nav"));
    EXPECT_TRUE(has(page, "In 15 s of green 17 vehicles pass the stop line with CDG and 7 with CTG-Ref."));
    EXPECT_TRUE(has(page, "Not measured in these runs: gain with long greens."));
    EXPECT_TRUE(has(page, "Of 3 rows with results 2 are inside their tolerance, 1 outside, and 0 open."));
    std::size_t lines = 0;
    for (std::size_t at = page.find("<li>", answer); at < lines_end; at = page.find("<li>", at + 1)) ++lines;
    EXPECT_EQ(lines, 5u);
    EXPECT_LT(page.find("<a href=\"#fig05_counters\"><img"), page.find("<nav"));
}

TEST(ReportPage, GivesTheOriginOfEachFigure) {
    const std::string page = report_page(example_content());
    EXPECT_TRUE(has(page, "<figure id=\"fig05_counters\">"));
    EXPECT_TRUE(has(page, "alt=\"Fig. 5: Vehicles &amp; lines\""));
    EXPECT_TRUE(has(page, "href=\"figures/fig05_counters.png\""));
    EXPECT_TRUE(has(page, "<pre><code>stopline-run 'a b'</code></pre>"));
    EXPECT_TRUE(has(page, "Words &lt;b&gt;"));
    EXPECT_FALSE(has(page, "Words <b>"));
    EXPECT_TRUE(has(page, "1.2.3 &lt;&amp;&gt;"));
    EXPECT_TRUE(has(page, "No numbers."));
}

// The entries of the metrics explain the columns of the tables.
TEST(ReportPage, ExplainsTheColumnsOfItsTables) {
    const std::string page = report_page(example_content());
    for (const MetricGroup& group : metric_groups()) {
        EXPECT_TRUE(has(page, "<summary>Columns of " + std::string(group.title) + "</summary>"));
        for (const std::vector<ColumnDoc>* const columns : {&group.summary, &group.sweep}) {
            for (const ColumnDoc& column : *columns) EXPECT_TRUE(has(page, ">" + column.name + "<")) << column.name;
        }
    }
}

// The page can be opened from disk without a network connection.
TEST(ReportPage, NeedsNoExternalFiles) {
    const std::string page = report_page(example_content());
    for (const char* outside : {"http:", "https:", "<link", "<script", "@import", "url("}) {
        EXPECT_FALSE(has(page, outside)) << outside;
    }
    EXPECT_TRUE(has(page, "<html lang=\"en\">"));
    EXPECT_TRUE(has(page, "<meta charset=\"utf-8\">"));
}

TEST(ReportPage, MarksReducedRuns) {
    ReportContent content = example_content();
    EXPECT_FALSE(has(report_page(content), "REDUCED"));
    const TemporaryFolder folder;
    content.reductions =
        Reductions::load(folder.write("quick.csv", "applies_to,field,value\nsweeps/grid,repetitions,1\n"));
    const std::string page = report_page(content);
    EXPECT_TRUE(has(page, "REDUCED: quick run."));
    EXPECT_TRUE(has(page, "<span class=\"badge\">reduced</span>"));
    EXPECT_TRUE(has(page, "scenarios/sweeps/grid.yaml"));
}

TEST(ReportPage, ListsFailures) {
    ReportContent content = example_content();
    content.problems = {"single light: no <room>"};
    content.figures[0].picture.clear();
    content.figures[0].problem = "the runs failed: no <room>";
    const std::string page = report_page(content);
    EXPECT_TRUE(has(page, "Failed: single light: no &lt;room&gt;"));
    EXPECT_TRUE(has(page, "Missing: the runs failed"));
    EXPECT_FALSE(has(page, "<img"));
}

TEST(Figure, OfAReducedJobIsMarked) {
    Figure figure;
    figure.body = "plot x\n";
    const Figure marked = marked_as_reduced(figure);
    EXPECT_TRUE(has(marked.body, "REDUCED"));
    EXPECT_TRUE(marked.body.ends_with("plot x\n"));
}

TEST(Seeds, AreShownAsARangeIfConsecutive) {
    EXPECT_EQ(seeds_text({}), "none");
    EXPECT_EQ(seeds_text({3}), "3");
    EXPECT_EQ(seeds_text({1, 2, 3}), "1 to 3");
    EXPECT_EQ(seeds_text({1, 5}), "1, 5");
}

}  // namespace
}  // namespace stopline
