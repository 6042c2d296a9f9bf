// Table 1 and the figures over turn ratios, from a made-up table of results.
#include "figures/studies/turn_figures.h"

#include <gtest/gtest.h>

#include <string>

#include "runs/tables/column_docs.h"

namespace stopline {
namespace {

CsvTable results() {
    return parse_csv(
        "green_s,left_percent,right_percent,population,seed,throughput_veh_h,travel_time_94m_s,density_network_percent\n"
        "15,0,0,CTG-Ref,1,5000,55,31\n"
        "15,0,0,CTG-Ref,2,5200,57,33\n"
        "15,0,0,CDG,1,12000,31,42\n"
        "15,0,0,CDG,2,12480,33,44\n"
        "15,30,0,CDG,1,7000,48,40\n",
        "by hand");
}

TEST(TurnFigures, RequireTheAxesAndMetricsOfAnIntersection) {
    EXPECT_TRUE(has_turns(results()));
    EXPECT_FALSE(has_turns(parse_csv("green_s,left_percent,population,seed,passed_1_veh\n15,0,CDG,1,3\n", "by hand")));
}

TEST(TurnFigures, HaveOneFigurePerGreenWithMeansOverSeeds) {
    const std::vector<Figure> figures = turn_figures(results());
    ASSERT_EQ(figures.size(), 1u);
    EXPECT_EQ(figures[0].name, "turns_green_15");
    ASSERT_EQ(figures[0].data.size(), 3u);
    EXPECT_NE(figures[0].data[0].second.find("0/0 5100 12240\n"), std::string::npos) << figures[0].data[0].second;
    EXPECT_NE(figures[0].data[0].second.find("30/0 NaN 7000\n"), std::string::npos);
    EXPECT_EQ(figures[0].body.find("Fig."), std::string::npos) << "own intersections are not in the paper";
}

TEST(Table1, HasOurValueAndTheDifferenceForMeasuredPoints) {
    Target known;
    known.id = "T03";
    known.section = "IV Table 1";
    known.condition = "CDG green=15 left=0 right=0";
    known.value = "120";
    Target missing = known;
    missing.id = "T27";
    missing.condition = "CDG green=15 left=30 right=0";
    const std::string csv = table1_csv(results(), {known, missing});
    EXPECT_NE(csv.find("T03,CDG,15,0,0,120,140.0,20.0\n"), std::string::npos) << csv;
    EXPECT_NE(csv.find("T27,CDG,15,30,0,120,,\n"), std::string::npos) << csv;
    for (const std::string& column : parse_csv(csv, "table1.csv").columns) {
        EXPECT_NO_THROW(column_doc(table_docs(), "sweep/table1.csv", column)) << column;
    }
}

TEST(ThroughputTrends, CountRisesAndPointsAboveTheStraightLine) {
    const ThroughputTrends trends = throughput_trends(parse_csv(
        "green_s,left_percent,right_percent,population,seed,throughput_veh_h,travel_time_94m_s,density_network_percent\n"
        "15,0,0,CTG-Ref,1,5000,55,31\n"
        // The line from CTG-Ref (0 % CDG) to CDG (100 %) gives 7,000 at 40 % CDG.
        "15,0,0,P40,1,7100,55,31\n"
        "15,0,0,CDG,1,10000,31,42\n"
        "15,0,10,CTG-Ref,1,4000,55,31\n"
        "15,0,10,P40,1,5000,55,31\n"  // below the line, which gives 5,600
        "15,0,10,CDG,1,8000,31,42\n"
        "15,5,0,CTG-Ref,1,4900,55,31\n"
        "15,5,0,CDG,1,10200,31,42\n",
        "by hand"));
    EXPECT_EQ(trends.steps, 5);
    EXPECT_EQ(trends.rises, 1);
    EXPECT_NEAR(trends.largest_rise_percent, 2.0, 1e-9);
    EXPECT_EQ(trends.points, 2);
    EXPECT_EQ(trends.above_line, 1);
}

TEST(TurnCondition, IsParsedOnlyIfComplete) {
    const std::optional<TurnCondition> mix = parse_turn_condition("MIX green=5 left=30 right=0");
    ASSERT_TRUE(mix.has_value());
    EXPECT_EQ(mix->population, "P50");
    EXPECT_EQ(mix->left_percent, 30.0);
    EXPECT_FALSE(parse_turn_condition("CTG-Ref green=15 all turn ratios").has_value());
    EXPECT_FALSE(parse_turn_condition("CDG green=15").has_value());
}

}  // namespace
}  // namespace stopline
