// Evaluation of platoon trajectories: the start of the platoon leader, and vehicles in steady state.
#include "runs/single_light/platoon.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace stopline {
namespace {

constexpr double kLimit_mps = 50.0 / 3.6;
constexpr double kInterval_s = 0.1;

// Returns the trajectory of one vehicle from time 0. Speed and gap are functions of time.
std::vector<TrajectoryPoint> samples(int vehicle, int policy, double until_s,
                                     const std::function<double(double)>& speed_mps,
                                     const std::function<double(double)>& gap_m) {
    std::vector<TrajectoryPoint> points;
    for (int k = 0; k * kInterval_s <= until_s; ++k) {
        const double time_s = k * kInterval_s;
        points.push_back({time_s, vehicle, policy, 0, 0.0, 0.0, speed_mps(time_s), 0.0, 0.0, gap_m(time_s), 1, 5.15});
    }
    return points;
}

double steady_gap_m(double /*time_s*/) { return 2.95; }

TEST(LeaderStart, LastsFromTheLastRestToTheLimit) {
    // The vehicle is at rest for one second, then accelerates with 1 m/s2 up to the limit.
    const auto speed = [](double t) { return std::min(kLimit_mps, std::max(0.0, t - 1.0)); };
    const LeaderStart start = leader_start(samples(0, 0, 30.0, speed, steady_gap_m), kLimit_mps);
    EXPECT_NEAR(start.start_s, 1.0, 0.11);
    EXPECT_NEAR(start.duration_s(), (50.0 - 0.5) / 3.6, 0.11);
}

TEST(LeaderStart, IsNaNForAVehicleThatNeverReachesTheLimit) {
    const auto slow = [](double t) { return std::min(10.0, t); };
    EXPECT_TRUE(std::isnan(leader_start(samples(0, 0, 30.0, slow, steady_gap_m), kLimit_mps).duration_s()));
    EXPECT_TRUE(std::isnan(leader_start({}, kLimit_mps).duration_s()));
}

TEST(SteadyVehicles, NeedFiveSecondsAtTheLimitWithASteadyGap) {
    const auto at_limit = [](double /*t*/) { return kLimit_mps; };
    EXPECT_EQ(steady_vehicles(samples(3, 1, 4.8, at_limit, steady_gap_m), kInterval_s, kLimit_mps).size(), 0U);
    const auto steady = steady_vehicles(samples(3, 1, 5.2, at_limit, steady_gap_m), kInterval_s, kLimit_mps);
    ASSERT_EQ(steady.size(), 1U);
    EXPECT_EQ(steady[0].vehicle, 3);
    EXPECT_EQ(steady[0].policy, 1);
    EXPECT_DOUBLE_EQ(steady[0].net_gap_m, 2.95);
    EXPECT_NEAR(steady[0].headway_s, (5.15 + 2.95) / kLimit_mps, 1e-12);
}

TEST(SteadyVehicles, ExcludeSlowerClosingAndLeadingVehicles) {
    const auto at_limit = [](double /*t*/) { return kLimit_mps; };
    const auto slower = [](double /*t*/) { return kLimit_mps - 0.2; };
    const auto closing = [](double t) { return 20.0 - 0.05 * t; };
    const auto none = [](double /*t*/) { return std::nan(""); };
    EXPECT_TRUE(steady_vehicles(samples(0, 0, 9.0, slower, steady_gap_m), kInterval_s, kLimit_mps).empty());
    EXPECT_TRUE(steady_vehicles(samples(0, 0, 9.0, at_limit, closing), kInterval_s, kLimit_mps).empty());
    EXPECT_TRUE(steady_vehicles(samples(0, 0, 9.0, at_limit, none), kInterval_s, kLimit_mps).empty());
}

// A vehicle in the rear of a platoon that closes up drives faster than a vehicle without leader. Its gap stays constant
// until the vehicles ahead have closed up. Such a vehicle counts as cruising, but not as steady.
TEST(CruisingVehicles, IncludeThoseFasterThanTheCruiseSpeed) {
    const auto faster = [](double /*t*/) { return 1.05 * kLimit_mps; };
    const auto slower = [](double /*t*/) { return kLimit_mps - 0.2; };
    const auto open_gap = [](double /*t*/) { return 18.0; };
    const auto cruising = cruising_vehicles(samples(4, 0, 9.0, faster, open_gap), kInterval_s, kLimit_mps);
    ASSERT_EQ(cruising.size(), 1U);
    EXPECT_DOUBLE_EQ(cruising[0].net_gap_m, 18.0);
    EXPECT_TRUE(steady_vehicles(samples(4, 0, 9.0, faster, open_gap), kInterval_s, kLimit_mps).empty());
    EXPECT_TRUE(cruising_vehicles(samples(4, 0, 9.0, slower, open_gap), kInterval_s, kLimit_mps).empty());
}

TEST(HasClosedUp, AllowsAQuarterOfTheGapAndHalfAMetre) {
    EXPECT_TRUE(has_closed_up(2.95, 2.95));
    EXPECT_TRUE(has_closed_up(5.5, 4.0));
    EXPECT_FALSE(has_closed_up(5.51, 4.0));
    EXPECT_FALSE(has_closed_up(17.1, 2.95));
}

TEST(SteadyVehicles, UseTheLastSteadyTimeOfEachVehicle) {
    const auto brakes_at_20 = [](double t) { return t < 20.0 ? kLimit_mps : 5.0; };
    const auto slowly_growing = [](double t) { return 15.0 + 0.01 * t; };
    std::vector<TrajectoryPoint> points = samples(8, 0, 30.0, brakes_at_20, slowly_growing);
    const auto other = samples(
        2, 0, 30.0, [](double /*t*/) { return kLimit_mps; }, steady_gap_m);
    // A run gives its points in the order of time, then of vehicles.
    points.insert(points.end(), other.begin(), other.end());
    std::stable_sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.time_s < b.time_s; });
    const auto steady = steady_vehicles(points, kInterval_s, kLimit_mps);
    ASSERT_EQ(steady.size(), 2U);
    EXPECT_EQ(steady[0].vehicle, 2);
    EXPECT_EQ(steady[1].vehicle, 8);
    EXPECT_NEAR(steady[1].net_gap_m, 15.199, 0.0015);
}

}  // namespace
}  // namespace stopline
