// Tests of the figures of stopline-strings.
#include "figures/string_figures.h"

#include <gtest/gtest.h>

#include <string>

#include "scenario/load_scenario.h"

namespace stopline {
namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

StringReport short_report(bool swings) {
    const Scenario scenario =
        parse_scenario("{network: {kind: approach}, populations: [CDG, CTG-Ref]}", "strings.yaml");
    StringOptions options;
    options.vehicles = 3;
    options.speed_mps = default_string_speed_mps(scenario);
    if (swings) options.frequencies_radps = {2.0};
    options.starts = false;
    return run_strings(scenario, options);
}

TEST(StringFigures, ShowEachPopulation) {
    const StringReport report = short_report(true);
    const std::vector<Figure> figures = string_figures(report);
    ASSERT_EQ(figures.size(), 4U);  // gain, positions, and the braking of two populations
    EXPECT_EQ(figures[0].name, "gain");
    EXPECT_TRUE(has(figures[0].body, "'CDG'") && has(figures[0].body, "'CTG-Ref'"));
    EXPECT_TRUE(has(figures[0].data[0].second, "\n2.00"));
    EXPECT_EQ(figures[2].name, "brake_1");
    EXPECT_TRUE(has(figures[2].body, "CDG: the platoon leader brakes hard"));
    EXPECT_EQ(figures[3].name, "brake_2");
    for (const Figure& figure : figures) {
        EXPECT_TRUE(figure.nothing.empty());
        for (const auto& [name, data] : figure.data) EXPECT_TRUE(has(figure.body, "'" + name + "'")) << figure.name;
    }
}

TEST(StringFigures, HaveNoGainWithoutSwings) {
    const StringReport report = short_report(false);
    EXPECT_FALSE(string_gain_figure(report).nothing.empty());
    EXPECT_EQ(string_figures(report).front().name, "positions");
}

TEST(StringFigures, BorderSeparatesGrowingPoints) {
    StringSweep sweep;
    sweep.population = "CTG-Ref";
    sweep.points = {{0.1, 0.5, 1.02, 0.6, {}, true}, {0.1, 0.9, 0.98, 0.6, {}, true}};
    sweep.border = {{0.1, 0.7, 0.71}};
    const Figure figure = string_border_figure(sweep);
    EXPECT_TRUE(has(figure.data[0].second, "100.000 0.500 1 1.02000"));
    EXPECT_TRUE(has(figure.data[0].second, "100.000 0.900 0 0.98000"));
    EXPECT_TRUE(has(figure.data[1].second, "100.000 0.7000 0.7100"));
}

}  // namespace
}  // namespace stopline
