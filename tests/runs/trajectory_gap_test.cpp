// The net gap of a trajectory is that to the vehicle ahead on its route, on whatever lane that one is.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "runs/run.h"
#include "runs/short_scenario.h"

namespace stopline {
namespace {

// A queue of one lane that starts and crosses the stop line to the next lane, vehicle by vehicle.
TEST(TrajectoryGap, IsThatToTheVehicleAheadAcrossLanes) {
    const Scenario scenario = short_scenario();
    RunOptions options;
    options.trajectory_interval_s = scenario.tick_s();
    options.trajectory_from_s = scenario.signal.first_green_s;
    const RunResult run = run_population(scenario, 0, options);
    std::map<double, std::map<int, const TrajectoryPoint*>> by_time;  // vehicles are numbered from the front
    for (const TrajectoryPoint& point : run.trajectory) by_time[point.time_s][point.vehicle] = &point;
    int across = 0;
    for (const auto& [time_s, vehicles] : by_time) {
        const TrajectoryPoint* ahead = nullptr;
        for (const auto& [id, point] : vehicles) {
            if (ahead == nullptr) {
                EXPECT_TRUE(std::isnan(point->net_gap_m)) << "leader at " << time_s;
            } else {
                EXPECT_NEAR(point->net_gap_m, ahead->distance_m - scenario.vehicle.length_m - point->distance_m, 1e-5)
                    << "vehicle " << id << " at " << time_s;
                across += ahead->lane == point->lane ? 0 : 1;
            }
            ahead = point;
        }
    }
    EXPECT_GT(across, 100);
}

}  // namespace
}  // namespace stopline
