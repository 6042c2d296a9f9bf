// The net gap of a trajectory point is measured to the leader on the route, on any lane.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "runs/run.h"
#include "runs/short_scenario.h"

namespace stopline {
namespace {

// The vehicles of a starting queue cross the stop line to the next lane one by one.
TEST(TrajectoryGap, IsMeasuredToTheLeaderAcrossLanes) {
    const Scenario scenario = short_scenario();
    RunOptions options;
    options.trajectory_interval_s = scenario.tick_s();
    options.trajectory_from_s = scenario.signal.first_green_s;
    const RunResult run = run_population(scenario, 0, options);
    std::map<double, std::map<int, const TrajectoryPoint*>> by_time;  // vehicles are numbered from the front
    for (const TrajectoryPoint& point : run.trajectory) by_time[point.time_s][point.vehicle] = &point;
    int across_lanes = 0;
    for (const auto& [time_s, vehicles] : by_time) {
        const TrajectoryPoint* leader = nullptr;
        for (const auto& [id, point] : vehicles) {
            if (leader == nullptr) {
                EXPECT_TRUE(std::isnan(point->net_gap_m)) << "first vehicle at " << time_s;
            } else {
                EXPECT_NEAR(point->net_gap_m, leader->distance_m - scenario.vehicle.length_m - point->distance_m, 1e-5)
                    << "vehicle " << id << " at " << time_s;
                across_lanes += leader->lane == point->lane ? 0 : 1;
            }
            leader = point;
        }
    }
    EXPECT_GT(across_lanes, 100);
}

}  // namespace
}  // namespace stopline
