// Tests of the growth of accelerations along the queue of a single light.
#include "runs/single_light/queue_stability.h"

#include <gtest/gtest.h>

#include <cmath>

#include "runs/short_scenario.h"
#include "runs/single_light/single_light_csv.h"
#include "runs/single_light/single_light_metrics.h"

namespace stopline {
namespace {

TEST(QueueStability, ComparesEachVehicleWithItsLeader) {
    const Scenario scenario = short_scenario({"populations=[CDG, CTG-Ref]"});
    std::vector<LinePassage> line(3);
    for (int k = 0; k < 3; ++k) line[static_cast<std::size_t>(k)].vehicle = 10 + k;
    std::vector<TrajectoryPoint> points;
    const auto add = [&](double time_s, int vehicle, double acceleration_mps2, double net_gap_m) {
        TrajectoryPoint point;
        point.time_s = time_s;
        point.vehicle = vehicle;
        point.speed_mps = 10.0;
        point.acceleration_mps2 = acceleration_mps2;
        point.net_gap_m = net_gap_m;
        points.push_back(point);
    };
    add(49.0, 11, 9.0, 0.1);  // before the start of green
    add(51.0, 10, 2.0, std::nan(""));
    add(52.0, 10, -1.0, std::nan(""));
    add(51.0, 11, 2.2, 2.95);
    add(52.0, 11, -2.5, 2.5);
    add(52.0, 12, 2.0, 3.55);
    add(52.0, 13, 9.0, 0.2);  // does not pass within the green
    const QueueStability result = queue_stability(scenario, scenario.populations[0], line, points, 50.0);
    EXPECT_DOUBLE_EQ(result.linf_ratio, 1.25);
    EXPECT_DOUBLE_EQ(result.linf_from_head, 1.25);
    EXPECT_NEAR(result.gap_error_m, 0.6, 1e-9);  // the gap of CDG is 2.95 m
    EXPECT_DOUBLE_EQ(result.smallest_gap_m, 2.5);
    EXPECT_TRUE(std::isnan(queue_stability(scenario, scenario.populations[0], {}, points, 50.0).linf_ratio));
}

TEST(QueueStability, IsAMetricOnlyIfAskedFor) {
    const SingleLightReport without = run_single_light(short_scenario());
    EXPECT_EQ(summary_csv(without).find("string_"), std::string::npos);
    EXPECT_TRUE(std::isnan(without.populations[0].stability.linf_ratio));
    const SingleLightReport with = run_single_light(short_scenario({"measure.string_stability=on"}));
    EXPECT_NE(summary_csv(with).find("string_linf_ratio,string_linf_from_head,string_gap_error_m,"), std::string::npos);
    for (std::size_t k = 0; k < with.runs.size(); ++k) {
        EXPECT_EQ(with.runs[k].state_hash, without.runs[k].state_hash);
        EXPECT_GT(with.populations[k].stability.linf_ratio, 0.5);
        EXPECT_LT(with.populations[k].stability.linf_ratio, 1.5);
        EXPECT_GT(with.populations[k].stability.smallest_gap_m, 2.0);
    }
    // With a constant distance, the gap hardly changes during the start.
    EXPECT_LT(with.populations[0].stability.gap_error_m, 0.5);
}

}  // namespace
}  // namespace stopline
