// Comfort and surrogate safety: closed forms, and no influence on the run.
#include "runs/driving/safety_results.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "runs/driving/driving_csv.h"
#include "runs/run.h"
#include "runs/short_scenario.h"

namespace stopline {
namespace {

TEST(TimeToCollision, IsTheNetGapOverTheClosingSpeed) {
    EXPECT_DOUBLE_EQ(time_to_collision_s({15.0, 15.0, 10.0, 0.0}), 3.0);
    EXPECT_TRUE(std::isinf(time_to_collision_s({15.0, 10.0, 10.0, 0.0})));
    EXPECT_TRUE(std::isinf(time_to_collision_s({15.0, 9.0, 10.0, -3.0})));
    EXPECT_DOUBLE_EQ(time_to_collision_s({-0.1, 15.0, 10.0, 0.0}), 0.0);
}

TEST(RequiredDeceleration, BehindASteadyLeaderHasAClosedForm) {
    EXPECT_DOUBLE_EQ(required_deceleration_mps2({20.0, 10.0, 0.0, 0.0}), 2.5);   // v^2 / (2 gap)
    EXPECT_DOUBLE_EQ(required_deceleration_mps2({20.0, 15.0, 5.0, 0.0}), 2.5);   // closing speed instead of v
    EXPECT_DOUBLE_EQ(required_deceleration_mps2({20.0, 10.0, 10.0, 0.0}), 0.0);  // equal speeds
    EXPECT_DOUBLE_EQ(required_deceleration_mps2({20.0, 15.0, 5.0, 1.0}), 1.5);   // the leader accelerates
    // Both stop: the follower has the gap and the stopping distance of the leader, 10^2 / (2 x 4) m.
    EXPECT_DOUBLE_EQ(required_deceleration_mps2({2.0, 10.0, 10.0, -4.0}), 100.0 / (2.0 * (2.0 + 12.5)));
}

// Returns the smallest gap until the follower stops that brakes with a constant deceleration.
double smallest_gap_m(FollowingState s, double deceleration_mps2) {
    constexpr double kStep_s = 0.002;
    double smallest_m = s.net_gap_m;
    for (int k = 0; k < 20'000 && s.speed_mps > 0.0; ++k) {
        const double before_mps = s.speed_mps - s.leader_mps;
        s.speed_mps = std::max(s.speed_mps - deceleration_mps2 * kStep_s, 0.0);
        s.leader_mps = std::max(s.leader_mps + s.leader_mps2 * kStep_s, 0.0);
        s.net_gap_m -= 0.5 * (before_mps + s.speed_mps - s.leader_mps) * kStep_s;
        smallest_m = std::min(smallest_m, s.net_gap_m);
    }
    return smallest_m;
}

TEST(RequiredDeceleration, JustAvoidsTheLeader) {
    for (std::uint64_t k = 0; k < 200; ++k) {
        const auto draw = [&](std::uint64_t purpose, double from, double to) {
            const double share = static_cast<double>((k * 2654435761u + purpose * 40503u) % 1000u) / 1000.0;
            return from + share * (to - from);
        };
        const FollowingState s{draw(1, 1.0, 30.0), draw(2, 1.0, 20.0), draw(3, 0.0, 20.0), draw(4, -6.0, 0.0)};
        const double needed_mps2 = required_deceleration_mps2(s);
        if (needed_mps2 > 0.0) {
            EXPECT_GT(smallest_gap_m(s, needed_mps2), -0.05) << k;
            EXPECT_LT(smallest_gap_m(s, 0.9 * needed_mps2), 0.0) << k;
        } else {
            EXPECT_GE(smallest_gap_m(s, 0.0), 0.0) << k;
        }
    }
}

TEST(SafetyDistribution, HasTheQuantilesOfAUniformSample) {
    SafetyDistribution distribution({"test", "test", 0.0, 0.1, 100});
    EXPECT_TRUE(std::isnan(distribution.quantile(0.5)));
    for (int k = 0; k < 1000; ++k) distribution.add(0.01 * k);
    EXPECT_NEAR(distribution.quantile(0.5), 5.0, 0.02);
    EXPECT_NEAR(distribution.quantile(0.99), 9.9, 0.02);
    distribution.add(1000.0);  // beyond the last bin
    EXPECT_DOUBLE_EQ(distribution.largest(), 1000.0);
    EXPECT_DOUBLE_EQ(distribution.smallest(), 0.0);
    EXPECT_EQ(distribution.samples().back(), 11);
}

TEST(SurrogateSafety, ChangesNoRun) {
    for (const char* fidelity : {"fidelity=full", "fidelity=meso"}) {
        const RunResult off = run_population(short_scenario({fidelity}), 0, {});
        const RunResult on = run_population(short_scenario({fidelity, "measure.surrogate_safety=on"}), 0, {});
        EXPECT_EQ(on.state_hash, off.state_hash);
        EXPECT_EQ(safety_distributions_csv({{"CDG", off.driving}}), "");
        EXPECT_NE(safety_distributions_csv({{"CDG", on.driving}}), "");
    }
}

// The gaps of a run are those of its policies.
TEST(SurrogateSafety, ShowsTheGapsOfThePolicies) {
    const Scenario scenario = short_scenario({"measure.surrogate_safety=on"});
    const SafetyResult cdg = run_population(scenario, 0, {}).driving.safety;
    const SafetyResult ctg = run_population(scenario, 2, {}).driving.safety;
    const auto largest_bin_m = [](const SafetyResult& result) {
        const std::vector<std::int64_t>& samples = result.of(SafetyMeasure::net_gap).samples();
        const auto bin = std::max_element(samples.begin(), samples.end()) - samples.begin();
        return 0.5 * static_cast<double>(bin);
    };
    // 2.95 m, and 2 m or so plus 0.87 s at 50 km/h: 15.03 m (first_steps.yaml prints both).
    EXPECT_NEAR(largest_bin_m(cdg), 2.75, 0.3);
    EXPECT_NEAR(largest_bin_m(ctg), 15.0, 0.3);
    EXPECT_GT(cdg.of(SafetyMeasure::net_gap).smallest(), 0.0);
    EXPECT_LT(cdg.of(SafetyMeasure::time_gap).smallest(), ctg.of(SafetyMeasure::time_gap).smallest());
}

// Recomputes the measures from the trajectories of the run.
TEST(SurrogateSafety, AgreesWithTheTrajectories) {
    const Scenario scenario = short_scenario({"measure.surrogate_safety=on"});
    RunOptions options;
    options.trajectory_interval_s = 0.1;
    const RunResult run = run_population(scenario, 0, options);
    const SafetyResult& safety = run.driving.safety;
    std::map<int, std::vector<TrajectoryPoint>> vehicles;
    for (const TrajectoryPoint& point : run.trajectory) vehicles[point.vehicle].push_back(point);
    double lowest_jerk = 0.0;
    double highest_jerk = 0.0;
    double smallest_gap_m = 1e9;
    std::int64_t hard_brakings = 0;
    for (const auto& [vehicle, points] : vehicles) {
        bool brakes_hard = false;
        for (std::size_t k = 1; k < points.size(); ++k) {
            const double a = (points[k].speed_mps - points[k - 1].speed_mps) / 0.1;
            if (a < -3.0 && !brakes_hard) ++hard_brakings;
            brakes_hard = a < -3.0 || (brakes_hard && a <= -2.0);
            if (points[k].speed_mps < 0.1) continue;
            if (!std::isnan(points[k].net_gap_m)) smallest_gap_m = std::min(smallest_gap_m, points[k].net_gap_m);
            if (k < 2) continue;
            const double before = (points[k - 1].speed_mps - points[k - 2].speed_mps) / 0.1;
            lowest_jerk = std::min(lowest_jerk, (a - before) / 0.1);
            highest_jerk = std::max(highest_jerk, (a - before) / 0.1);
        }
    }
    EXPECT_GT(hard_brakings, 0);
    EXPECT_EQ(safety.hard_brakings, hard_brakings);
    EXPECT_NEAR(safety.of(SafetyMeasure::jerk).smallest(), lowest_jerk, 1e-6);
    EXPECT_NEAR(safety.of(SafetyMeasure::jerk).largest(), highest_jerk, 1e-6);
    EXPECT_NEAR(safety.of(SafetyMeasure::net_gap).smallest(), smallest_gap_m, 1e-6);
}

}  // namespace
}  // namespace stopline
