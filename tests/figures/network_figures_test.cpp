// Figures of network runs can be drawn for runs of any length, or give a reason why there is nothing to draw.
#include <gtest/gtest.h>

#include "figures/network_figures.h"
#include "figures/population_style.h"
#include "figures/street_figures.h"
#include "figures/time_space_figure.h"
#include "runs/network/street_results.h"
#include "scenario/load_scenario.h"
#include "scenario/scenario_text.h"

namespace stopline {
namespace {

NetworkReport report_of(const char* file, const std::vector<std::string>& overrides) {
    return run_networks(load_scenario(std::string(STOPLINE_SOURCE_DIR "/scenarios/") + file, overrides), {2, {}, {}});
}

// Returns the error message of drawing a figure; empty: no error.
std::string error_of(const Figure& figure) {
    const TemporaryFolder folder;
    return input_error_of([&] { draw(figure, folder.path()); });
}

TEST(NetworkFigures, AreDrawnForFewIntervals) {
    if (!gnuplot_installed()) GTEST_SKIP() << "no gnuplot";
    struct Run {
        const char* duration;
        const char* interval;
    };
    for (const Run& run : {Run{"1200 s", "300 s"}, Run{"299 s", "60 s"}, Run{"60 s", "60 s"}, Run{"8 s", "4 s"}}) {
        const NetworkReport report =
            report_of("arterial.yaml", {std::string("duration=") + run.duration,
                                        std::string("measure.interval=") + run.interval, "measure.window=4 s"});
        EXPECT_EQ(error_of(network_series_figure(report)), "") << run.duration;
        EXPECT_EQ(error_of(time_space_figure(report)), "") << run.duration;
    }
}

TEST(NetworkFigures, GiveTheReasonIfThereIsNothingToDraw) {
    const NetworkReport report =
        report_of("arterial.yaml", {"duration=30 s", "measure.window=10 s", "measure.time_space=0.5 s"});
    EXPECT_TRUE(contains(network_series_figure(report).nothing, "no whole interval of 60 s (measure.interval)"));
    EXPECT_TRUE(contains(time_space_figure(report).nothing, "in the last 0.5 s (measure.time_space)"));
    EXPECT_TRUE(contains(error_of(time_space_figure(report)), "cannot draw time_space: no vehicle"));
}

TEST(StreetFigures, AreDrawnForFewIntervals) {
    if (!gnuplot_installed()) GTEST_SKIP() << "no gnuplot";
    for (const char* const duration : {"125 s", "60 s", "30 s"}) {
        const NetworkReport report =
            report_of("berlin.yaml", {std::string("duration=") + duration, "measure.interval=60 s", "populations=[CDG]",
                                      "measure.baseline=CDG", "measure.window=10 s"});
        for (const Figure& figure : {network_series_figure(report), inflow_figure(report), backlog_figure(report)}) {
            EXPECT_EQ(figure.nothing.empty() ? error_of(figure) : "", "") << duration;
        }
        EXPECT_TRUE(contains(backlog_figure(report).body, "unset label\n"))
            << "gnuplot would draw the note with each panel";
        EXPECT_EQ(inflow_figure(report).nothing.empty(), std::string(duration) != "30 s") << duration;
    }
}

TEST(NetworkFigures, OmitCausesWithoutDelay) {
    const NetworkReport report = report_of("arterial.yaml", {"duration=120 s", "measure.window=60 s"});
    const Figure figure = delay_causes_figure(report);
    EXPECT_TRUE(contains(figure.body, "title 'signal'"));
    EXPECT_FALSE(contains(figure.body, "title 'gridlock'"));
}

TEST(NetworkFigures, UseOneColourForEachPopulation) {
    const NetworkReport report = report_of("arterial.yaml", {"duration=120 s", "measure.window=60 s"});
    const std::string cdg_colour = style_of(report.scenario, "CDG").colour;
    EXPECT_EQ(cdg_colour, line_style(0).colour) << "CDG has the same colour in all figures";
    EXPECT_NE(style_of(report.scenario, "CTG-Ref").colour, cdg_colour);
    EXPECT_TRUE(contains(network_series_figure(report).body,
                         "'series_2.dat' using 1:2 with linespoints pt 7 ps 0.4 lw 2 lc rgb '" + cdg_colour));
    EXPECT_TRUE(contains(time_space_figure(report).body, "lc rgb '" + cdg_colour + "' title 'CDG'"));
}

}  // namespace
}  // namespace stopline
