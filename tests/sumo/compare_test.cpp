#include "sumo/compare.h"

#include <gtest/gtest.h>

#include <cmath>

namespace stopline {
namespace {

TEST(ComparedMetric, HasNoDifferenceInPercentOfNothing) {
    EXPECT_NEAR((ComparedMetric{"a", {110.0, 130.0}, {90.0, 110.0}}.difference_percent()), 20.0, 1e-9);
    EXPECT_TRUE(std::isnan((ComparedMetric{"a", {1.0}, {0.0}}.difference_percent())));
    EXPECT_TRUE(std::isnan((ComparedMetric{"a", {0.0}, {0.0}}.difference_percent())));
    EXPECT_NEAR((ComparedMetric{"a", {0.0}, {5.0}}.difference_percent()), -100.0, 1e-9);
}

TEST(Comparison, WaitingOutsideIsOfSumoAlone) {
    Comparison comparison{"", "CTG-Ref", 0.0, 100.0, {}};
    comparison.runs.emplace_back();
    comparison.runs[0].ours.trips = {{50.0, 30.0, 0.0}};
    comparison.runs[0].sumo.trips = {{60.0, 40.0, 7.0}};
    for (const ComparedMetric& metric : comparison.metrics()) {
        EXPECT_EQ(metric.of_sumo_alone, metric.name == "wait_outside_s") << metric.name;
        const double percent = metric.difference_percent();
        if (metric.of_sumo_alone) {
            EXPECT_TRUE(std::isnan(percent));
        } else if (metric.name == "travel_time_s") {
            EXPECT_NEAR(percent, -25.0, 1e-9);
        }
    }
}

}  // namespace
}  // namespace stopline
