// Figures of sweeps over networks, from made-up tables of results.
#include "figures/studies/sweep_figures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenario/scenario_text.h"
#include "scenario/sweep_file/load_sweep.h"

namespace stopline {
namespace {

constexpr const char* kMetricColumns = "population,seed,throughput_veh_h,travel_time_s,density_percent,stability\n";

// Returns a result table with rows for all combinations of axis values. A run of CTG has a throughput of 1000 veh/h, a
// run of CDG 1200 veh/h. `columns` names the axes, such as "green_s,offset_s"; `points` has their values, such as
// "5,0".
CsvTable table_of(const std::string& columns, const std::vector<std::string>& points, int seeds = 1) {
    std::string text = columns + "," + kMetricColumns;
    for (const std::string& point : points) {
        for (int seed = 1; seed <= seeds; ++seed) {
            text += fmt::format("{},CTG,{},1000,100,20,stable\n", point, seed);
            text += fmt::format("{},CDG,{},1200,80,15,stable\n", point, seed);
        }
    }
    return parse_csv(text, "by hand");
}

std::vector<std::string> names_of(const std::vector<Figure>& figures) {
    std::vector<std::string> names;
    for (const Figure& figure : figures) names.push_back(figure.name);
    return names;
}

const Figure& figure_named(const std::vector<Figure>& figures, const std::string& name) {
    const auto found = std::find_if(figures.begin(), figures.end(), [&](const Figure& f) { return f.name == name; });
    if (found == figures.end()) throw std::logic_error("no figure " + name);
    return *found;
}

bool lacks(const std::string& text, const std::string& part) { return text.find(part) == std::string::npos; }

TEST(NetworkSweepFigures, CanBeDrawnWithoutTravelTimesAndHaveReadableTitles) {
    if (!gnuplot_installed()) GTEST_SKIP() << "no gnuplot";
    const CsvTable results = parse_csv(
        "point,traffic,green_s,offset_s,population,seed,throughput_veh_h,travel_time_s,density_percent,stability\n"
        "0,{left: 5 %},10,0,A,1,0,,30,unstable\n",
        "table");
    ASSERT_TRUE(is_network_sweep(results));
    const std::vector<Figure> figures = sweep_figures(results, {{{"traffic", "{left: 5 %}"}, "traffic left 5 %"}});
    const TemporaryFolder folder;
    for (const Figure& figure : figures) {
        EXPECT_EQ(input_error_of([&] { draw(figure, folder.path()); }), "");
        EXPECT_TRUE(contains(figure.body, "'traffic left 5 %; offset 0 s'"));
    }
}

// The table lacks some values and has several seeds. The names contain quotes and underscores.
TEST(NetworkSweepFigures, CanBeDrawnWithMissingValuesAndSpecialCharacters) {
    if (!gnuplot_installed()) GTEST_SKIP() << "no gnuplot";
    const CsvTable results = parse_csv(std::string("green_s,offset_s,") + kMetricColumns +
                                           "5,0,A_1,1,1000,,20,stable\n5,0,A_1,2,1100,,20,unstable\n"
                                           "5,0,B's,1,0,90,20,stable\n5,9,A_1,1,0,,20,stable\n"
                                           "8,0,A_1,1,1000,,20,semi-stable\n8,9,B's,1,900,80,20,stable\n",
                                       "by hand");
    const std::vector<Figure> figures = sweep_figures(results, {});
    EXPECT_EQ(names_of(figures), (std::vector<std::string>{"network_1", "surfaces_1", "stability_1"}));
    const TemporaryFolder folder;
    for (const Figure& figure : figures) EXPECT_EQ(input_error_of([&] { draw(figure, folder.path()); }), "");
}

TEST(NetworkSweepFigures, IncludeSurfacesOnlyForTwoGreensAndTwoOffsets) {
    const auto names = [](const std::vector<std::string>& points) {
        return names_of(sweep_figures(table_of("green_s,offset_s", points), {}));
    };
    const std::vector<std::string> without{"network_1", "stability_1"};
    EXPECT_EQ(names({"5,0", "5,10", "9,0", "9,10"}),
              (std::vector<std::string>{"network_1", "surfaces_1", "stability_1"}));
    EXPECT_EQ(names({"5,0", "9,0"}), without);
    EXPECT_EQ(names({"5,0", "5,10"}), without);
}

TEST(NetworkSweepFigures, SurfacesShowValuesAndChanges) {
    const CsvTable results = parse_csv(std::string("green_s,offset_s,") + kMetricColumns +
                                           "5,0,CTG,1,1000,100,20,stable\n5,0,CDG,1,1500,75,15,stable\n"
                                           "5,9,CTG,1,1000,100,20,stable\n5,9,CDG,1,900,110,22,stable\n"
                                           "8,0,CTG,1,1000,100,20,stable\n8,0,CDG,1,1000,100,20,stable\n"
                                           "8,9,CTG,1,2000,100,20,stable\n",
                                       "by hand");
    const Figure figure = figure_named(sweep_figures(results, {}), "surfaces_1");
    const std::string& data = figure.data.front().second;
    // Each line has the column and row of the cell, the value as a number, the value as text, and the colour of the
    // text: 0 (black) on light cells, 16777215 (white) on dark cells.
    EXPECT_TRUE(
        contains(data, "# CDG, throughput [veh/h]\n0 0 1500 1500 0\n0 1 900 900 16777215\n1 0 1000 1000 16777215\n"));
    EXPECT_TRUE(contains(data,
                         "# CTG, throughput [veh/h]\n0 0 1000 1000 16777215\n0 1 1000 1000 16777215\n1 0 1000 "
                         "1000 16777215\n1 1 2000 2000 0\n"));
    EXPECT_TRUE(
        contains(data, "# CDG, throughput gain over CTG [%]\n0 0 50 +50.0 16777215\n0 1 -10 -10.0 0\n1 0 0 0.0 0\n"));
    EXPECT_TRUE(contains(data, "# CDG, travel time saved against CTG [%]\n0 0 25 +25.0 16777215\n0 1 -10 -10.0 0\n"));
    EXPECT_TRUE(contains(data, "# CDG, density change against CTG [%]\n0 0 -25 -25.0 16777215\n0 1 10 +10.0 0\n"));
    // Both populations share the scale of throughput. The scale of changes is symmetric about 0.
    const std::size_t first = figure.body.find("set cbrange [900:2000]");
    EXPECT_NE(first, std::string::npos);
    EXPECT_NE(figure.body.find("set cbrange [900:2000]", first + 1), std::string::npos);
    EXPECT_TRUE(contains(figure.body, "set cbrange [-50:50]"));
}

TEST(NetworkSweepFigures, PlaceTicksAtValuesWithoutOverlap) {
    const auto lines = [](const std::vector<std::string>& points) {
        return figure_named(sweep_figures(table_of("green_s,offset_s", points), {}), "network_1").body;
    };
    EXPECT_TRUE(contains(lines({"25,0", "30,0", "35,0"}), "set xtics (25, 30, 35)\n"));
    std::vector<std::string> many;
    for (int green_s = 20; green_s <= 120; green_s += 5) many.push_back(fmt::format("{},0", green_s));
    EXPECT_TRUE(contains(lines(many), "set xtics (20, 40, 60, 80, 100, 120)\n"));
    EXPECT_TRUE(contains(lines({"5,0", "6,0", "100,0"}), "set xtics (5, 100)\n"));
}

TEST(NetworkSweepFigures, DistinguishSevenOffsets) {
    std::vector<std::string> points;
    for (int offset_s = 0; offset_s < 42; offset_s += 6) {
        for (const int green_s : {10, 20}) points.push_back(fmt::format("{},{}", green_s, offset_s));
    }
    const std::string body = figure_named(sweep_figures(table_of("green_s,offset_s", points), {}), "network_1").body;
    std::set<std::string> styles;
    std::size_t entries = 0;
    for (std::size_t at = body.find("NaN with linespoints "); at != std::string::npos;
         at = body.find("NaN with linespoints ", at + 1)) {
        ++entries;
        styles.insert(body.substr(at, body.find(" title", at) - at));
    }
    EXPECT_EQ(entries, 7u);  // one for each offset, not one for each of the 14 lines (7 offsets, 2 populations)
    EXPECT_EQ(styles.size(), 7u);
    EXPECT_TRUE(contains(body, "title 'offset 36 s'"));
    EXPECT_TRUE(contains(body, "title 'CDG'"));
}

TEST(NetworkSweepFigures, NameTheOffsetsAndTheBaseline) {
    const std::string body =
        figure_named(sweep_figures(table_of("green_s,offset_s", {"5,0", "5,18", "8,0", "8,18"}), {}), "network_1").body;
    EXPECT_TRUE(contains(body, "title 'CDG, offset 18 s'"));
    EXPECT_TRUE(contains(body, "'throughput gain over CTG [%]'"));
    EXPECT_TRUE(contains(body, "'travel time saved against CTG [%]'"));
    EXPECT_TRUE(contains(body, "'density change against CTG [%]'"));
    EXPECT_TRUE(contains(body, "0 with lines lw 1 dt 1 "));
}

TEST(NetworkSweepFigures, ShowAReductionOfDensityAsNegative) {
    const Figure lines = figure_named(sweep_figures(table_of("green_s,offset_s", {"5,0", "9,0"}), {}), "network_1");
    EXPECT_TRUE(contains(lines.data.front().second,
                         "# CDG\n5 1200 1200 1200 80 80 80 15 15 15 20 20 20 20 20 20 -25 -25 -25\n"));
}

TEST(NetworkSweepFigures, UseOffsetsAsAxisIfThereIsOneGreen) {
    const std::vector<Figure> figures = sweep_figures(table_of("green_s,offset_s", {"15,0", "15,5", "15,10"}), {});
    const std::string& body = figure_named(figures, "network_1").body;
    EXPECT_TRUE(contains(body, "set xlabel 'offset [s]'"));
    EXPECT_TRUE(contains(body, "set xtics (0, 5, 10)\n"));
    EXPECT_TRUE(contains(body, "title 'green 15 s'"));
    EXPECT_TRUE(contains(figure_named(figures, "stability_1").body, "set ytics ('CDG' 0, 'CTG' 1)"));
}

TEST(NetworkSweepFigures, ReserveSpaceOnlyForAnExistingTitle) {
    const auto body = [](const std::string& columns, const std::vector<std::string>& points) {
        return figure_named(sweep_figures(table_of(columns, points), {}), "network_1").body;
    };
    const std::string untitled = body("green_s,offset_s", {"5,0", "5,9", "8,0", "8,9"});
    EXPECT_TRUE(contains(untitled, "set multiplot layout 2,3 margins 0.075,"));
    EXPECT_TRUE(contains(untitled, ",0.0800,0.97 spacing"));
    const std::string titled = body("left_percent,green_s,offset_s", {"4,5,0", "4,5,9", "4,8,0", "4,8,9"});
    EXPECT_TRUE(contains(titled, "title 'left 4 %' margins 0.075,"));
    EXPECT_TRUE(contains(titled, ",0.0800,0.94 spacing"));
}

// With t(0.975, 2) = 4.30265, the mean of 1300, 1000 and 1000 has the interval 1100 -+ 430.265. The differences between
// runs with the same seed are 300, 500 and 100, so their mean has the interval 300 -+ 496.828, or 37.5 -+ 62.1034 % of
// the mean of the baseline, 800.
TEST(SweepFigures, HaveConfidenceIntervalsOverTheSeeds) {
    const CsvTable results = parse_csv(std::string("green_s,offset_s,") + kMetricColumns +
                                           "5,0,CTG,1,1000,100,20,stable\n5,0,CTG,2,500,100,20,stable\n"
                                           "5,0,CTG,3,900,100,20,stable\n5,0,CDG,1,1300,100,20,stable\n"
                                           "5,0,CDG,2,1000,100,20,stable\n5,0,CDG,3,1000,100,20,stable\n",
                                       "by hand");
    const Figure figure = figure_named(sweep_figures(results, {}), "network_1");
    EXPECT_TRUE(contains(figure.data.front().second,
                         "# CDG\n5 1100 669.735 1530.27 100 100 100 20 20 20 37.5 -24.6034 99.6034 0 0 0 0 0 0\n"));
    EXPECT_TRUE(contains(figure.body, "with yerrorbars"));
    EXPECT_TRUE(contains(figure.body, "; means of 3 seeds with 95 % confidence intervals'"));
    const Figure single = figure_named(sweep_figures(table_of("green_s,offset_s", {"5,0", "8,0"}), {}), "network_1");
    EXPECT_TRUE(lacks(single.body, "yerrorbars"));
}

// The baseline comes first, wherever it is in the table. A population has the same colour in every figure.
TEST(SweepFigures, CompareWithTheBaseline) {
    const CsvTable results = table_of("green_s,offset_s", {"5,0", "8,0"});
    const Figure figure = figure_named(sweep_figures(results, {}, "population", "CDG"), "network_1");
    EXPECT_LT(figure.data.front().second.find("# CDG\n"), figure.data.front().second.find("# CTG\n"));
    EXPECT_TRUE(contains(figure.body, "throughput gain over CDG"));
    EXPECT_TRUE(contains(figure.body, line_style(0).colour));
    const Figure first = figure_named(sweep_figures(results, {}, "population", "unknown"), "network_1");
    EXPECT_TRUE(contains(first.body, "throughput gain over CTG"));
}

TEST(SweepFigures, ShowSingleLightsAndIntersections) {
    const CsvTable light = parse_csv(
        "point,switch_speed_kmh,population,seed,passed_1_veh,passed_2_veh,queue_emptied_s,steady_headway_s\n"
        "0,20,A,1,5,9,40,1.4\n1,30,A,1,6,11,36,1.2\n2,20,B,1,4,8,44,1.6\n3,30,B,1,4,8,44,1.6\n",
        "light");
    const std::vector<Figure> of_light = sweep_figures(light, {});
    ASSERT_EQ(of_light.size(), 1U);
    EXPECT_EQ(of_light[0].name, "lines_1");
    EXPECT_TRUE(contains(of_light[0].data.front().second, "# B\n20 8 8 8 44 44 44 1.6 1.6 1.6 -11.1111 -11.1111"));
    const CsvTable intersection = parse_csv(
        "point,green_s,population,seed,throughput_veh_h,vehicles_per_green,queue_veh\n"
        "0,10,A,1,4000,4,7\n1,15,A,1,5000,6,8\n",
        "intersection");
    ASSERT_EQ(sweep_figures(intersection, {}).size(), 1U);
    EXPECT_TRUE(contains(sweep_figures(intersection, {})[0].body, "queue at the start of green"));
}

TEST(NetworkSweepFigures, ShowTheWorstStabilityAndItsShareOfSeeds) {
    const CsvTable results =
        parse_csv(std::string("green_s,offset_s,") + kMetricColumns +
                      "5,0,CTG,1,1,1,1,stable\n5,0,CTG,2,1,1,1,unstable\n5,0,CTG,3,1,1,1,semi-stable\n"
                      "5,9,CTG,1,1,1,1,stable\n5,9,CTG,2,1,1,1,stable\n5,9,CTG,3,1,1,1,stable\n"
                      "8,0,CTG,1,1,1,1,semi-stable\n8,0,CTG,2,1,1,1,semi-stable\n",
                  "by hand");
    const Figure figure = figure_named(sweep_figures(results, {}), "stability_1");
    const std::string& data = figure.data.front().second;
    EXPECT_TRUE(contains(data, "\n0 0 2 1/3\n0 1 0 3/3\n1 0 1 2/2\n"));
    EXPECT_TRUE(contains(figure.body, "using 1:($2-0.27):4 with labels"));
    EXPECT_TRUE(contains(figure.body, "'each cell: worst result of 3 seeds, and share of seeds with it'"));
    const Figure single = figure_named(sweep_figures(table_of("green_s,offset_s", {"5,0", "8,0"}), {}), "stability_1");
    EXPECT_TRUE(lacks(single.body, "with labels"));
}

TEST(NetworkSweepFigures, UseAnotherNumericAxisAndExplainIt) {
    const CsvTable results = table_of("spacing_m,rule", {"200,on", "300,on", "200,off", "300,off"});
    EXPECT_FALSE(is_network_sweep(results));
    const CellTitles titles{{{"spacing_m", "200"}, "spacing 200 m / 150 m"},
                            {{"spacing_m", "300"}, "spacing 300 m / 200 m"},
                            {{"rule", "on"}, "rule on"},
                            {{"rule", "off"}, "rule off"}};
    const std::vector<Figure> figures = sweep_figures(results, titles);
    EXPECT_EQ(names_of(figures), (std::vector<std::string>{"network_1", "stability_1", "network_2", "stability_2"}));
    EXPECT_TRUE(contains(figures[0].body, "set xlabel 'spacing [m]'"));
    EXPECT_TRUE(contains(figures[2].body, "title 'rule off'"));
    EXPECT_EQ(
        sweep_figures_note(results, titles),
        "No figures over green and offset: they need the columns green_s and offset_s (columns found: spacing_m, rule); "
        "the figures use spacing_m instead, for each combination of the other axes");
}

// Without a numeric axis, the last axis of texts is the x axis. The points of the populations stand side by side.
TEST(NetworkSweepFigures, CompareTextsIfNoNumbersVary) {
    const CsvTable results =
        table_of("lanes,rule", {"three,off", "three,on", "three,full", "four,off", "four,on", "four,full"});
    const std::vector<Figure> figures = sweep_figures(results, {});
    ASSERT_EQ(names_of(figures), (std::vector<std::string>{"network_1", "network_2"}));
    EXPECT_TRUE(contains(figures[0].body, "('off' 0, 'on' 1, 'full' 2)"));
    EXPECT_TRUE(contains(figures[0].body, "set xlabel 'rule'"));
    EXPECT_TRUE(contains(figures[0].body, " with points "));
    EXPECT_TRUE(lacks(figures[0].body, "with linespoints pt"));
    EXPECT_TRUE(contains(figures[1].body, "title 'lanes four'"));
    const std::string& data = figures[0].data.front().second;
    EXPECT_TRUE(contains(data, "\n-0.125 "));
    EXPECT_TRUE(contains(data, "\n0.125 "));
    EXPECT_TRUE(contains(data, "\n2.125 "));
    EXPECT_TRUE(contains(sweep_figures_note(results, {}), "the figures use rule instead"));
}

TEST(NetworkSweepFigures, UseTwoOtherAxesWithTheOffsetAsLines) {
    const CsvTable results = table_of("offset_s,columns", {"0,3", "9,3", "0,5", "9,5"});
    const CellTitles titles{{{"columns", "3"}, "columns 3"}, {{"columns", "5"}, "columns 5"}};
    const std::vector<Figure> figures = sweep_figures(results, titles);
    EXPECT_EQ(names_of(figures), (std::vector<std::string>{"network_1", "surfaces_1", "stability_1"}));
    EXPECT_TRUE(contains(figures[0].body, "set xlabel 'columns'"));
    EXPECT_TRUE(contains(figures[0].body, "title 'CDG, offset 9 s'"));
    EXPECT_TRUE(contains(sweep_figures_note(results, titles),
                         "(columns found: offset_s, columns); the figures use columns and offset_s instead"));
}

TEST(NetworkSweepFigures, GiveTheReasonIfThereAreNone) {
    std::vector<std::string> many;
    for (int k = 0; k < 25; ++k) many.push_back("1,1," + std::to_string(k));
    EXPECT_EQ(sweep_figures(table_of("a,b,c", {"1,1,1", "2,2,2"}), {}).size(), 6U) << "figures over a and b for each c";
    many.insert(many.end(), {"2,1,1", "1,2,1"});
    EXPECT_TRUE(sweep_figures(table_of("a,b,c", many), {}).empty());
    EXPECT_EQ(
        sweep_figures_note(table_of("a,b,c", many), {}),
        "No figures over green and offset: they need the columns green_s and offset_s (columns found: a, b, c); there are "
        "no figures over the first two numeric axes either, because they would be more than 24");
    EXPECT_EQ(sweep_figures_note(table_of("green_s,offset_s", {"5,0"}), {}), "");
    EXPECT_EQ(sweep_figures_note(parse_csv("green_s,population,seed,passed\n5,A,1,2\n", "one light"), {}), "");
}

TEST(NetworkSweepFigures, ExplainHowToSplitAnAxisOfSeveralFields) {
    const CsvTable results = table_of("green,offset_s", {"30 s / 14 s,0", "30 s / 10 s,5"});
    const std::string note = sweep_figures_note(results, {});
    EXPECT_TRUE(contains(
        note,
        "(columns found: green, offset_s); the figures use offset_s instead, for each combination of the other axes; "
        "column 'green' combines several fields"));
    EXPECT_TRUE(contains(note, "('30 s / 14 s')"));
    EXPECT_TRUE(contains(note, "give each field an axis of its own, or put a field first that differs in every value"));
}

// data/paper/figures.csv lists the figures of the report. The shipped sweeps of Section VI must draw each figure that
// the list assigns to them.
TEST(NetworkSweepFigures, IncludeTheFiguresOfTheReport) {
    const CsvTable listed = parse_csv(read_text(shipped("data/paper/figures.csv")), "figures.csv");
    std::size_t surfaces = 0;
    for (const auto& [job, file] :
         {std::pair{"arterial", "arterial"}, {"grid", "grid"}, {"grid_stability", "stability"}}) {
        const Sweep sweep(load_sweep(shipped(fmt::format("scenarios/sweeps/{}.yaml", file))));
        std::string text = fmt::format("{},seed,{}\n", fmt::join(sweep.columns(), ","),
                                       "throughput_veh_h,travel_time_s,density_percent,stability");
        for (std::size_t point = 0; point < sweep.points(); ++point) {
            for (const std::string& cell : sweep.cells(point)) text += "\"" + cell + "\",";
            text += "1,1000,100,20,stable\n";
        }
        const CsvTable results = parse_csv(text, file);
        ASSERT_TRUE(is_network_sweep(results)) << file;
        const std::vector<std::string> drawn = names_of(sweep_figures(results, sweep.titles()));
        for (const std::vector<std::string>& row : listed.rows) {
            if (row[listed.column("job")] != job) continue;
            const std::string& name = row[listed.column("file")];
            EXPECT_NE(std::find(drawn.begin(), drawn.end(), name), drawn.end()) << job << "/" << name;
            surfaces += name.starts_with("surfaces_") ? 1U : 0U;
        }
    }
    EXPECT_EQ(surfaces, 4u);  // Fig. 17 to 20
}

TEST(NetworkSweepFigures, AcceptAnyNameOfThePopulationAxis) {
    const CsvTable results = parse_csv(
        "green_s,offset_s,policy,seed,throughput_veh_h,travel_time_s,density_percent,stability\n5,0,A,1,1,1,1,stable\n",
        "by hand");
    EXPECT_TRUE(sweep_figures(results, {}).empty());
    EXPECT_FALSE(sweep_figures(results, {}, "policy").empty());
}

}  // namespace
}  // namespace stopline
