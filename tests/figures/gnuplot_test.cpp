// Tests of drawing with gnuplot: files, errors, quoting and line styles. The figures of a single-light run can be drawn
// for any settings.
#include "figures/gnuplot.h"

#include <gtest/gtest.h>
#include <stdlib.h>  // setenv is POSIX

#include <set>

#include "figures/single_light_figures.h"
#include "runs/short_scenario.h"
#include "scenario/scenario_text.h"

namespace stopline {
namespace {

namespace fs = std::filesystem;

Figure line_figure(const std::string& body) {
    Figure figure;
    figure.name = "line";
    figure.data = {{"line.dat", "0 0\n1 1\n"}};
    figure.body = body;
    return figure;
}

std::set<std::string> names_in(const fs::path& folder) {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename().string());
    return names;
}

TEST(Draw, WritesOnlyPicturesScriptAndData) {
    if (!gnuplot_installed()) GTEST_SKIP() << "no gnuplot";
    const TemporaryFolder folder;
    draw(line_figure("plot 'line.dat' with lines notitle"), folder.path());
    EXPECT_EQ(names_in(folder.path()), (std::set<std::string>{"line.svg", "line.png", "line.gp", "line.dat"}));
    EXPECT_TRUE(contains(read_text(folder.path() / "line.svg"), "</svg>"));
    EXPECT_TRUE(contains(read_text(folder.path() / "line.png"), "IEND"));
}

TEST(Draw, WritesTheSameBytesEachTime) {
    if (!gnuplot_installed()) GTEST_SKIP() << "no gnuplot";
    const TemporaryFolder first;
    const TemporaryFolder second;
    const Figure figure = line_figure("plot 'line.dat' with lines notitle");
    draw(figure, first.path());
    draw(figure, second.path());
    for (const char* name : {"line.svg", "line.png", "line.gp"}) {
        EXPECT_EQ(read_text(first.path() / name), read_text(second.path() / name)) << name;
    }
}

TEST(Draw, ReportsTheErrorOfGnuplotAndKeepsTheScript) {
    if (!gnuplot_installed()) GTEST_SKIP() << "no gnuplot";
    const TemporaryFolder folder;
    const std::string error = input_error_of([&] { draw(line_figure("plot nonsense("), folder.path()); });
    EXPECT_TRUE(contains(error, "cannot draw"));
    EXPECT_TRUE(contains(error, "line.gp"));
    EXPECT_EQ(names_in(folder.path()), (std::set<std::string>{"line.gp", "line.dat"}));
}

TEST(Draw, ReportsThatGnuplotIsMissing) {
    const char* const path = ::getenv("PATH");
    const std::string before = path == nullptr ? "" : path;
    ::setenv("PATH", "/nonexistent", 1);
    const bool installed = gnuplot_installed();
    const TemporaryFolder folder;
    const std::string error = input_error_of([&] { draw(line_figure("plot 'line.dat'"), folder.path()); });
    ::setenv("PATH", before.c_str(), 1);
    EXPECT_FALSE(installed);
    EXPECT_TRUE(contains(error, "No such file or directory"));
}

TEST(GnuplotText, EscapesSpecialCharacters) {
    EXPECT_EQ(gnuplot_text("CTG-Ref"), "'CTG-Ref'");
    EXPECT_EQ(gnuplot_text("it's"), "'it''s'");
    EXPECT_EQ(gnuplot_text("a_b^c{d}"), "'a\\_b\\^c\\{d\\}'");
    EXPECT_EQ(gnuplot_text("two\nlines"), "'two lines'");
}

TEST(LineStyles, DistinguishEightPopulationsByColourAndByDashAndPoint) {
    std::set<std::string> colours;
    std::set<std::pair<int, int>> marks;
    for (std::size_t k = 0; k < 8; ++k) {
        EXPECT_TRUE(colours.insert(line_style(k).colour).second) << k;
        EXPECT_TRUE(marks.insert({line_style(k).dash, line_style(k).hollow_point}).second) << k;
    }
}

TEST(SingleLightFigures, CanBeDrawnForAnySettings) {
    if (!gnuplot_installed()) GTEST_SKIP() << "no gnuplot";
    for (const char* override_text : {"demand.vehicles=12", "demand.vehicles=1", "network.approach.lanes=2",
                                      "populations=[CTG-Ref]", "measure.green=[]", "signal.cycle=40 s"}) {
        const SingleLightReport result = run_single_light(short_scenario({override_text}));
        const TemporaryFolder folder;
        for (const Figure& figure : single_light_figures(result, load_targets())) {
            EXPECT_EQ(input_error_of([&] { draw(figure, folder.path()); }), "") << override_text;
        }
        EXPECT_TRUE(fs::exists(folder.path() / "counters.svg")) << override_text;
        EXPECT_TRUE(fs::exists(folder.path() / "time_space.png")) << override_text;
    }
}

TEST(SingleLightFigures, ShowNumbersOfThePaperOnlyForItsScenario) {
    Scenario scenario = short_scenario();
    EXPECT_FALSE(counters_figure(run_single_light(scenario), load_targets()).body.find("paper") != std::string::npos)
        << "the paper has no numbers for this scenario";
    scenario.name = "single_light";
    const Figure figure = counters_figure(run_single_light(scenario), load_targets());
    EXPECT_TRUE(contains(figure.body, "paper (Fig. 5)"));
    ASSERT_EQ(figure.data.size(), 2U);
    EXPECT_TRUE(contains(figure.data[1].second, "15 17\n"));
    EXPECT_EQ(figure.data[1].second.find("15 7\n"), std::string::npos) << "the scenario has no population CTG-HBS";
}

}  // namespace
}  // namespace stopline
