// Figures of sweeps over several intersections, from tables of results made by hand.
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

// Rows of all combinations: columns "green_s,offset_s", and every run passes 1000 (CTG) or 1200 vehicles (CDG).
CsvTable table_of(const std::string& columns, const std::vector<std::string>& places, int seeds = 1) {
    std::string text = columns + "," + kMetricColumns;
    for (const std::string& place : places) {
        for (int seed = 1; seed <= seeds; ++seed) {
            text += fmt::format("{},CTG,{},1000,100,20,stable\n", place, seed);
            text += fmt::format("{},CDG,{},1200,80,15,stable\n", place, seed);
        }
    }
    return parse_csv(text, "by hand");
}

std::vector<std::string> names_of(const std::vector<Figure>& figures) {
    std::vector<std::string> names;
    for (const Figure& figure : figures) names.push_back(figure.name);
    return names;
}

const Figure& named(const std::vector<Figure>& figures, const std::string& name) {
    const auto found = std::find_if(figures.begin(), figures.end(), [&](const Figure& f) { return f.name == name; });
    if (found == figures.end()) throw std::logic_error("no figure " + name);
    return *found;
}

bool lacks(const std::string& text, const std::string& part) { return text.find(part) == std::string::npos; }

TEST(NetworkSweepFigures, AreDrawnWithoutTravelTimesUnderTitlesInWords) {
    if (!gnuplot_installed()) GTEST_SKIP() << "no gnuplot";
    const CsvTable results = parse_csv(
        "point,traffic,green_s,offset_s,population,seed,throughput_veh_h,travel_time_s,density_percent,stability\n"
        "0,{left: 5 %},10,0,A,1,0,,30,unstable\n",
        "table");
    ASSERT_TRUE(is_network_sweep(results));
    const std::vector<Figure> figures =
        network_sweep_figures(results, {{{"traffic", "{left: 5 %}"}, "traffic left 5 %"}});
    const TemporaryFolder folder;
    for (const Figure& figure : figures) {
        EXPECT_EQ(input_error_of([&] { draw(figure, folder.path()); }), "");
        EXPECT_TRUE(contains(figure.body, "'traffic left 5 %; offset 0 s'"));
    }
}

// Some values missing, several seeds, quotes and underscores in names: gnuplot takes it all.
TEST(NetworkSweepFigures, AreDrawnWithHolesAndSeeds) {
    if (!gnuplot_installed()) GTEST_SKIP() << "no gnuplot";
    const CsvTable results = parse_csv(std::string("green_s,offset_s,") + kMetricColumns +
                                           "5,0,A_1,1,1000,,20,stable\n5,0,A_1,2,1100,,20,unstable\n"
                                           "5,0,B's,1,0,90,20,stable\n5,9,A_1,1,0,,20,stable\n"
                                           "8,0,A_1,1,1000,,20,semi-stable\n8,9,B's,1,900,80,20,stable\n",
                                       "by hand");
    const std::vector<Figure> figures = network_sweep_figures(results, {});
    EXPECT_EQ(names_of(figures), (std::vector<std::string>{"network_1", "surfaces_1", "stability_1"}));
    const TemporaryFolder folder;
    for (const Figure& figure : figures) EXPECT_EQ(input_error_of([&] { draw(figure, folder.path()); }), "");
}

TEST(NetworkSweepFigures, HaveSurfacesWhereThereAreTwoGreensAndTwoOffsets) {
    const auto names = [](const std::vector<std::string>& places) {
        return names_of(network_sweep_figures(table_of("green_s,offset_s", places), {}));
    };
    const std::vector<std::string> without{"network_1", "stability_1"};
    EXPECT_EQ(names({"5,0", "5,10", "9,0", "9,10"}),
              (std::vector<std::string>{"network_1", "surfaces_1", "stability_1"}));
    EXPECT_EQ(names({"5,0", "9,0"}), without);
    EXPECT_EQ(names({"5,0", "5,10"}), without);
}

TEST(NetworkSweepFigures, HaveValuesAndChangesInTheCellsOfSurfaces) {
    const CsvTable results = parse_csv(std::string("green_s,offset_s,") + kMetricColumns +
                                           "5,0,CTG,1,1000,100,20,stable\n5,0,CDG,1,1500,75,15,stable\n"
                                           "5,9,CTG,1,1000,100,20,stable\n5,9,CDG,1,900,110,22,stable\n"
                                           "8,0,CTG,1,1000,100,20,stable\n8,0,CDG,1,1000,100,20,stable\n"
                                           "8,9,CTG,1,2000,100,20,stable\n",
                                       "by hand");
    const Figure figure = named(network_sweep_figures(results, {}), "surfaces_1");
    const std::string& data = figure.data.front().second;
    // Cell, value, text, and ink: black on the light end of the scale, white on the dark one and on deep blue.
    EXPECT_TRUE(
        contains(data, "# CDG, throughput [veh/h]\n0 0 1500 1500 0\n0 1 900 900 16777215\n1 0 1000 1000 16777215\n"));
    EXPECT_TRUE(contains(data,
                         "# CTG, throughput [veh/h]\n0 0 1000 1000 16777215\n0 1 1000 1000 16777215\n1 0 1000 "
                         "1000 16777215\n1 1 2000 2000 0\n"));
    EXPECT_TRUE(
        contains(data, "# CDG, throughput gain over CTG [%]\n0 0 50 +50.0 16777215\n0 1 -10 -10.0 0\n1 0 0 0.0 0\n"));
    EXPECT_TRUE(contains(data, "# CDG, travel time saved against CTG [%]\n0 0 25 +25.0 16777215\n0 1 -10 -10.0 0\n"));
    EXPECT_TRUE(contains(data, "# CDG, density change against CTG [%]\n0 0 -25 -25.0 16777215\n0 1 10 +10.0 0\n"));
    // The scale of throughput is that of both populations, and of changes it is as long below 0 as above.
    const std::size_t first = figure.body.find("set cbrange [900:2000]");
    EXPECT_NE(first, std::string::npos);
    EXPECT_NE(figure.body.find("set cbrange [900:2000]", first + 1), std::string::npos);
    EXPECT_TRUE(contains(figure.body, "set cbrange [-50:50]"));
}

TEST(NetworkSweepFigures, HaveTicksAtTheirValuesThatDoNotOverlap) {
    const auto lines = [](const std::vector<std::string>& places) {
        return named(network_sweep_figures(table_of("green_s,offset_s", places), {}), "network_1").body;
    };
    EXPECT_TRUE(contains(lines({"25,0", "30,0", "35,0"}), "set xtics (25, 30, 35)\n"));
    std::vector<std::string> many;
    for (int green_s = 20; green_s <= 120; green_s += 5) many.push_back(fmt::format("{},0", green_s));
    EXPECT_TRUE(contains(lines(many), "set xtics (20, 40, 60, 80, 100, 120)\n"));
    EXPECT_TRUE(contains(lines({"5,0", "6,0", "100,0"}), "set xtics (5, 100)\n"));
}

TEST(NetworkSweepFigures, TellSevenOffsetsApart) {
    std::vector<std::string> places;
    for (int offset_s = 0; offset_s < 42; offset_s += 6) {
        for (const int green_s : {10, 20}) places.push_back(fmt::format("{},{}", green_s, offset_s));
    }
    const std::string body = named(network_sweep_figures(table_of("green_s,offset_s", places), {}), "network_1").body;
    std::set<std::string> looks;
    std::size_t entries = 0;
    for (std::size_t at = body.find("NaN with linespoints "); at != std::string::npos;
         at = body.find("NaN with linespoints ", at + 1)) {
        ++entries;
        looks.insert(body.substr(at, body.find(" title", at) - at));
    }
    EXPECT_EQ(entries, 7u);  // of 14 lines the key names colours and dashes apart
    EXPECT_EQ(looks.size(), 7u);
    EXPECT_TRUE(contains(body, "title 'offset 36 s'"));
    EXPECT_TRUE(contains(body, "title 'CDG'"));
}

TEST(NetworkSweepFigures, NameOffsetsAndWhomTheyCompareWith) {
    const std::string body =
        named(network_sweep_figures(table_of("green_s,offset_s", {"5,0", "5,18", "8,0", "8,18"}), {}), "network_1")
            .body;
    EXPECT_TRUE(contains(body, "title 'CDG, offset 18 s'"));
    EXPECT_TRUE(contains(body, "'throughput gain over CTG [%]'"));
    EXPECT_TRUE(contains(body, "'travel time saved against CTG [%]'"));
    EXPECT_TRUE(contains(body, "'density change against CTG [%]'"));
    EXPECT_TRUE(contains(body, "0 with lines lw 1 dt 1 "));
}

TEST(NetworkSweepFigures, ShowLowerDensityAsANegativeChange) {
    const Figure lines = named(network_sweep_figures(table_of("green_s,offset_s", {"5,0", "9,0"}), {}), "network_1");
    EXPECT_TRUE(contains(lines.data.front().second,
                         "# CDG\n5 1200 1200 1200 80 80 80 15 15 15 20 20 20 20 20 20 -25 -25 -25\n"));
}

TEST(NetworkSweepFigures, AreDrawnOverOffsetsWhereThereIsOneGreen) {
    const std::vector<Figure> figures =
        network_sweep_figures(table_of("green_s,offset_s", {"15,0", "15,5", "15,10"}), {});
    const std::string& body = named(figures, "network_1").body;
    EXPECT_TRUE(contains(body, "set xlabel 'offset [s]'"));
    EXPECT_TRUE(contains(body, "set xtics (0, 5, 10)\n"));
    EXPECT_TRUE(contains(body, "title 'green 15 s'"));
    EXPECT_TRUE(contains(named(figures, "stability_1").body, "set ytics ('CDG' 0, 'CTG' 1)"));
}

TEST(NetworkSweepFigures, LeaveNoRoomForATitleThatIsNotThere) {
    const auto body = [](const std::string& columns, const std::vector<std::string>& places) {
        return named(network_sweep_figures(table_of(columns, places), {}), "network_1").body;
    };
    const std::string untitled = body("green_s,offset_s", {"5,0", "5,9", "8,0", "8,9"});
    EXPECT_TRUE(contains(untitled, "set multiplot layout 2,3 margins 0.075,"));
    EXPECT_TRUE(contains(untitled, ",0.08,0.97 spacing"));
    const std::string titled = body("left_percent,green_s,offset_s", {"4,5,0", "4,5,9", "4,8,0", "4,8,9"});
    EXPECT_TRUE(contains(titled, "title 'left 4 %' margins 0.075,"));
    EXPECT_TRUE(contains(titled, ",0.08,0.94 spacing"));
}

// Least and greatest are of pairs of the same seed: 1300 of 1000 and 1000 of 500, not 1300 of 500.
TEST(NetworkSweepFigures, HaveWhiskersOfTheSeeds) {
    const CsvTable results = parse_csv(std::string("green_s,offset_s,") + kMetricColumns +
                                           "5,0,CTG,1,1000,100,20,stable\n5,0,CTG,2,500,100,20,stable\n"
                                           "5,0,CDG,1,1300,100,20,stable\n5,0,CDG,2,1000,100,20,stable\n",
                                       "by hand");
    const Figure figure = named(network_sweep_figures(results, {}), "network_1");
    EXPECT_TRUE(contains(figure.data.front().second,
                         "# CDG\n5 1150 1000 1300 100 100 100 20 20 20 53.3333 30 100 0 0 0 0 0 0\n"));
    EXPECT_TRUE(contains(figure.body, "with yerrorbars"));
    EXPECT_TRUE(contains(figure.body, "; means of 2 seeds, whiskers from minimum to maximum'"));
    const Figure single = named(network_sweep_figures(table_of("green_s,offset_s", {"5,0", "8,0"}), {}), "network_1");
    EXPECT_TRUE(lacks(single.body, "yerrorbars"));
}

TEST(NetworkSweepFigures, CountTheSeedsThatAreUnstable) {
    const CsvTable results =
        parse_csv(std::string("green_s,offset_s,") + kMetricColumns +
                      "5,0,CTG,1,1,1,1,stable\n5,0,CTG,2,1,1,1,unstable\n5,0,CTG,3,1,1,1,semi-stable\n"
                      "5,9,CTG,1,1,1,1,stable\n5,9,CTG,2,1,1,1,stable\n5,9,CTG,3,1,1,1,stable\n"
                      "8,0,CTG,1,1,1,1,semi-stable\n8,0,CTG,2,1,1,1,semi-stable\n",
                  "by hand");
    const Figure figure = named(network_sweep_figures(results, {}), "stability_1");
    const std::string& data = figure.data.front().second;
    EXPECT_TRUE(contains(data, "\n0 0 2 1/3\n0 1 0 3/3\n1 0 1 2/2\n"));
    EXPECT_TRUE(contains(figure.body, "using 1:($2-0.27):4 with labels"));
    EXPECT_TRUE(contains(figure.body, "'each cell: worst result of 3 seeds, and share of seeds with it'"));
    const Figure single = named(network_sweep_figures(table_of("green_s,offset_s", {"5,0", "8,0"}), {}), "stability_1");
    EXPECT_TRUE(lacks(single.body, "with labels"));
}

TEST(NetworkSweepFigures, AreDrawnOverAnotherAxisOfNumbersWithAWordOnIt) {
    const CsvTable results = table_of("spacing_m,rule", {"200,on", "300,on", "200,off", "300,off"});
    EXPECT_FALSE(is_network_sweep(results));
    const CellTitles titles{{{"spacing_m", "200"}, "spacing 200 m / 150 m"},
                            {{"spacing_m", "300"}, "spacing 300 m / 200 m"},
                            {{"rule", "on"}, "rule on"},
                            {{"rule", "off"}, "rule off"}};
    const std::vector<Figure> figures = network_sweep_figures(results, titles);
    EXPECT_EQ(names_of(figures), (std::vector<std::string>{"network_1", "stability_1", "network_2", "stability_2"}));
    EXPECT_TRUE(contains(figures[0].body, "set xlabel 'spacing [m]'"));
    EXPECT_TRUE(contains(figures[2].body, "title 'rule off'"));
    EXPECT_EQ(
        network_sweep_note(results, titles),
        "No figures over green and offset: they need axes whose columns are green_s and offset_s (here: spacing_m, "
        "rule); drawn over spacing_m, for each combination of the others");
}

TEST(NetworkSweepFigures, AreDrawnOverTwoOtherAxesWithTheOffsetAsLines) {
    const CsvTable results = table_of("offset_s,columns", {"0,3", "9,3", "0,5", "9,5"});
    const CellTitles titles{{{"columns", "3"}, "columns 3"}, {{"columns", "5"}, "columns 5"}};
    const std::vector<Figure> figures = network_sweep_figures(results, titles);
    EXPECT_EQ(names_of(figures), (std::vector<std::string>{"network_1", "surfaces_1", "stability_1"}));
    EXPECT_TRUE(contains(figures[0].body, "set xlabel 'columns'"));
    EXPECT_TRUE(contains(figures[0].body, "title 'CDG, offset 9 s'"));
    EXPECT_TRUE(contains(network_sweep_note(results, titles),
                         "(columns found: offset_s, columns); the figures use columns and offset_s instead"));
}

TEST(NetworkSweepFigures, SayWhyThereAreNone) {
    std::vector<std::string> many;
    for (int k = 0; k < 25; ++k) many.push_back("1,1," + std::to_string(k));
    EXPECT_EQ(network_sweep_figures(table_of("a,b,c", {"1,1,1", "2,2,2"}), {}).size(), 6U) << "a and b, for each c";
    many.insert(many.end(), {"2,1,1", "1,2,1"});
    EXPECT_TRUE(network_sweep_figures(table_of("a,b,c", many), {}).empty());
    EXPECT_EQ(
        network_sweep_note(table_of("a,b,c", many), {}),
        "No figures over green and offset: they need the columns green_s and offset_s (columns found: a, b, c); there are no "
        "figures over the first two numeric axes either, because they would be more than 24");
    EXPECT_EQ(network_sweep_note(table_of("green_s,offset_s", {"5,0"}), {}), "");
    EXPECT_EQ(network_sweep_note(parse_csv("green_s,population,seed,passed\n5,A,1,2\n", "one light"), {}), "");
}

TEST(NetworkSweepFigures, SayWhatToDoWithAnAxisOfSeveralFields) {
    const CsvTable results = table_of("green,offset_s", {"30 s / 14 s,0", "30 s / 10 s,5"});
    const std::string note = network_sweep_note(results, {});
    EXPECT_TRUE(contains(
        note,
        "(columns found: green, offset_s); the figures use offset_s instead, for each combination of the other axes; column 'green' combines several fields"));
    EXPECT_TRUE(contains(note, "('30 s / 14 s')"));
    EXPECT_TRUE(contains(note, "give each field an axis of its own, or put a field first that differs in every value"));
}

// What the report shows of Section VI's sweeps is drawn by them: figures of data/paper/figures.csv by the job's sweep file.
TEST(NetworkSweepFigures, AreThoseThatTheReportShows) {
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
        const std::vector<std::string> drawn = names_of(network_sweep_figures(results, sweep.titles()));
        for (const std::vector<std::string>& row : listed.rows) {
            if (row[listed.column("job")] != job) continue;
            const std::string& name = row[listed.column("file")];
            EXPECT_NE(std::find(drawn.begin(), drawn.end(), name), drawn.end()) << job << "/" << name;
            surfaces += name.starts_with("surfaces_") ? 1U : 0U;
        }
    }
    EXPECT_EQ(surfaces, 4u);  // Fig. 17 to 20
}

TEST(NetworkSweepFigures, KnowPopulationsByTheNameOfTheirAxis) {
    const CsvTable results = parse_csv(
        "green_s,offset_s,policy,seed,throughput_veh_h,travel_time_s,density_percent,stability\n5,0,A,1,1,1,1,stable\n",
        "by hand");
    EXPECT_TRUE(network_sweep_figures(results, {}).empty());
    EXPECT_FALSE(network_sweep_figures(results, {}, "policy").empty());
}

}  // namespace
}  // namespace stopline
