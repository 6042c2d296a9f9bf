// Tests of the figure of a search over signal times.
#include "figures/studies/timing_figure.h"

#include <gtest/gtest.h>

#include <string>

namespace stopline {
namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TimingSearch search_over(const std::vector<SearchedTimes>& settings) {
    TimingSearch search;
    search.population = "CTG-Ref";
    search.all = settings;
    return search;
}

TEST(TimingFigure, ShowsBothGreensOfAnIntersection) {
    const Figure figure = timing_figure(search_over({{{{20.0, 10.0}, 0.0}, 46.0, {15.0, 17.0}, {900.0, 900.0}},
                                                     {{{20.0, 30.0}, 0.0}, 66.0, {25.0, 27.0}, {900.0, 900.0}}}));
    EXPECT_EQ(figure.name, "search_CTG-Ref");
    EXPECT_TRUE(has(figure.data[0].second, "20 10 0 0 16.0000\n20 30 0 1 26.0000\n")) << figure.data[0].second;
    EXPECT_TRUE(has(figure.body, "green, south-north"));
    EXPECT_TRUE(has(figure.body, "'" + figure.data[0].first + "'"));
}

TEST(TimingFigure, ShowsTheBestCrossGreenForEachOffset) {
    TimingSearch search = search_over({{{{20.0, 10.0}, 0.0}, 46.0, {15.0}, {900.0}},
                                       {{{20.0, 30.0}, 0.0}, 66.0, {25.0}, {950.0}},
                                       {{{20.0, 30.0}, 14.0}, 66.0, {12.0}, {940.0}}});
    EXPECT_TRUE(has(timing_figure(search).data[0].second, "20 0 0 0 15.0000\n20 14 0 1 12.0000\n"));
    search.objective = Objective::throughput;
    EXPECT_TRUE(has(timing_figure(search).data[0].second, "20 0 0 0 950.0000\n20 14 0 1 940.0000\n"));
    EXPECT_TRUE(has(timing_figure(search).body, "offset [s]"));
}

}  // namespace
}  // namespace stopline
