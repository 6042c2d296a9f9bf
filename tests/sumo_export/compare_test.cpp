// Tests of the comparison with SUMO: metrics, tables and figures.
#include "sumo_export/compare.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "base/io/csv.h"
#include "runs/tables/column_docs.h"

namespace stopline {
namespace {

TEST(ComparedMetric, HasNoPercentageOfZero) {
    EXPECT_NEAR((ComparedMetric{"a", {110.0, 130.0}, {90.0, 110.0}}.difference_percent()), 20.0, 1e-9);
    EXPECT_TRUE(std::isnan((ComparedMetric{"a", {1.0}, {0.0}}.difference_percent())));
    EXPECT_TRUE(std::isnan((ComparedMetric{"a", {0.0}, {0.0}}.difference_percent())));
    EXPECT_NEAR((ComparedMetric{"a", {0.0}, {5.0}}.difference_percent()), -100.0, 1e-9);
}

TEST(Comparison, HasDepartureDelayOfSumoOnly) {
    Comparison comparison{"", "CTG-Ref", 0.0, 100.0, {}};
    comparison.runs.emplace_back();
    comparison.runs[0].ours.trips = {{50.0, 30.0, 0.0}};
    comparison.runs[0].sumo.trips = {{60.0, 40.0, 7.0}};
    for (const ComparedMetric& metric : comparison.metrics()) {
        EXPECT_EQ(metric.sumo_only, metric.name == "departure_delay_s") << metric.name;
        const double percent = metric.difference_percent();
        if (metric.sumo_only) {
            EXPECT_TRUE(std::isnan(percent));
        } else if (metric.name == "travel_time_s") {
            EXPECT_NEAR(percent, -25.0, 1e-9);
        }
    }
}

TEST(Comparison, ComparesDepartureDelayOnImportedNetworks) {
    Comparison comparison{"", "CTG-Ref", 0.0, 100.0};
    comparison.imported = true;
    comparison.has_stop_lines = false;
    comparison.runs.emplace_back();
    comparison.runs[0].ours.trips = {{50.0, 30.0, 2.0}};
    comparison.runs[0].ours.instants = {{98.0, 1, 0, 5.0, 7}, {99.0, 1, 0, 5.0, 6}};
    comparison.runs[0].sumo.trips = {{60.0, 40.0, 4.0}};
    comparison.runs[0].sumo.instants = {{99.0, 1, 0, 5.0, 3}};
    comparison.runs[0].sumo.teleported = 9;
    std::map<std::string, ComparedMetric> metrics;
    for (const ComparedMetric& metric : comparison.metrics()) metrics[metric.name] = metric;
    EXPECT_NEAR(metrics.at("departure_delay_s").difference_percent(), -50.0, 1e-9);
    EXPECT_NEAR(metrics.at("backlog").difference_percent(), 100.0, 1e-9);
    EXPECT_EQ(metrics.at("teleported").sumo, std::vector<double>{9.0});
    EXPECT_TRUE(std::isnan(metrics.at("stop_line_passages_veh_h").ours.at(0)));  // there are no stop lines
}

TEST(Comparison, DocumentsItsColumns) {
    Comparison comparison{"", "CTG-Ref", 0.0, 100.0};
    comparison.runs.emplace_back();
    for (const auto& [table, csv] : {std::pair{"compare/comparison.csv", comparison_csv(comparison)},
                                     std::pair{"compare/stop_lines.csv", stop_lines_csv(comparison)}}) {
        for (const std::string& column : parse_csv(csv, table).columns) {
            EXPECT_NO_THROW(column_doc(table_docs(), table, column)) << table << ' ' << column;
        }
    }
}

// With the first seed SUMO's vehicles arrive at 10 s and 20 s, with the second at 10 s and 40 s.
TEST(ComparisonFigures, ShowMeanAndBandOverSeeds) {
    Comparison comparison{"", "CTG-Ref", 0.0, 50.0};
    comparison.has_stop_lines = false;
    comparison.runs.resize(2);
    comparison.runs[0].sumo.trips = {{10.0, 1.0, 0.0}, {20.0, 1.0, 0.0}};
    comparison.runs[1].sumo.trips = {{40.0, 1.0, 0.0}, {10.0, 1.0, 0.0}};
    comparison.runs[1].ours.trips = {{30.0, 1.0, 0.0}};
    const std::vector<Figure> two_seeds = comparison_figures(comparison, "t");
    ASSERT_EQ(two_seeds.size(), 2U);  // no figure of stop-line passages, because there are no stop lines
    EXPECT_EQ(two_seeds[0].name, "arrivals");
    const std::string& rows = two_seeds[0].data.at(0).second;
    EXPECT_NE(rows.find("\n9,0.000,0.000,0.000,0.000\n"), std::string::npos) << rows;
    EXPECT_NE(rows.find("\n10,0.000,1.000,1.000,1.000\n"), std::string::npos) << rows;
    // The mean is 1.5. The band is 1.5 +- t s / sqrt(2), not below 0, with Student's t = 12.706 and standard deviation
    // s = 0.707.
    EXPECT_NE(rows.find("\n35,0.500,1.500,0.000,7.853\n"), std::string::npos) << rows;
    EXPECT_NE(two_seeds[0].body.find("filledcurves"), std::string::npos);
    comparison.runs.resize(1);
    const Figure one_seed = comparison_figures(comparison, "t")[0];
    EXPECT_EQ(one_seed.body.find("filledcurves"), std::string::npos);
    EXPECT_NE(one_seed.data.at(0).second.find("\n35,0.000,2.000,,\n"), std::string::npos);
}

}  // namespace
}  // namespace stopline
