// Tests of the ideal platoon, whose followers keep their gap law without error or delay. Compares the ideal platoon
// with closed forms, and the simulated platoon with the ideal platoon.
#include "runs/single_light/ideal_platoon.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/io/data_directory.h"
#include "runs/single_light/single_light.h"
#include "scenario/load_scenario.h"

namespace stopline {
namespace {

constexpr double kLength_m = 5.15;

GapPolicySettings policy(const std::string& law, double time_gap_s) {
    GapPolicySettings settings;
    settings.law = law;
    set_law_parameter(settings, "time_gap", time_gap_s);
    return settings;
}

// The leader drives at speed v from the start. With standstill gap s0 and time gap h, its follower drives at the speed
// v (1 - exp(-t / h)), a first-order lag. The k-th follower has k of these lags. When all drive at v, their headway is
// (length + s0 + h v) / v.
TEST(IdealPlatoon, TimeGapActsAsAChainOfLags) {
    const GapPolicySettings time_gap = policy("constant_time", 0.87);
    const double v = 12.0;
    const double h = law_parameter(time_gap, "time_gap");
    const std::vector<SpeedSample> leader{{0.0, v}};
    const IdealVehicle vehicle{&time_gap, kLength_m};
    const double line_m = 100.0;
    const std::vector<double> times_s = ideal_passages_s(leader, std::vector(3, vehicle), line_m, 60.0);
    ASSERT_EQ(times_s.size(), 3U);
    EXPECT_NEAR(times_s[0], line_m / v, 1e-9);
    // At the stop line all vehicles have reached v. Each lag has cost the distance h v, so successive fronts are
    // length + s0 + h v apart.
    const double headway_s = (kLength_m + time_gap.standstill_gap_m + h * v) / v;
    EXPECT_NEAR(times_s[1] - times_s[0], headway_s, 2e-3);
    EXPECT_NEAR(times_s[2] - times_s[1], headway_s, 2e-3);
    // At the start the first follower drives x(t) = v (t - h (1 - exp(-t / h))). The time below gives about 1 m.
    const double t = 0.453;
    const double start_m = v * (t - h * (1.0 - std::exp(-t / h)));
    const std::vector<double> early_s =
        ideal_passages_s(leader, std::vector(2, vehicle), start_m - kLength_m - time_gap.standstill_gap_m, 60.0);
    ASSERT_FALSE(early_s.empty());
    EXPECT_NEAR(early_s.back(), t, 0.01);
}

TEST(IdealPlatoon, ConstantDistancePlatoonMovesAsOneBody) {
    const GapPolicySettings distance = policy("constant_distance", 0.0);
    const std::vector<SpeedSample> leader{{0.0, 0.0}, {10.0, 15.0}};  // 1.5 m/s2, then 15 m/s
    const std::vector<double> times_s =
        ideal_passages_s(leader, std::vector(20, IdealVehicle{&distance, kLength_m}), 0.5, 60.0);
    ASSERT_EQ(times_s.size(), 20U);
    for (std::size_t k = 0; k < times_s.size(); ++k) {
        const double distance_m = 0.5 + static_cast<double>(k) * (kLength_m + distance.standstill_gap_m);
        const double time_s = distance_m < 75.0 ? std::sqrt(distance_m / 0.75) : 10.0 + (distance_m - 75.0) / 15.0;
        EXPECT_NEAR(times_s[k], time_s, 0.01) << k;
    }
}

TEST(IdealPlatoon, NeverPassesBehindAStoppedLeader) {
    const GapPolicySettings time_gap = policy("constant_time", 0.87);
    EXPECT_TRUE(ideal_passages_s({}, std::vector(2, IdealVehicle{&time_gap, kLength_m}), 0.5, 60.0).empty());
    EXPECT_TRUE(ideal_passages_s({}, {}, 0.5, 60.0).empty());
}

// The simulated platoon differs from the ideal one by its controllers and powertrains. With the SWITCH policies more
// simulated vehicles pass: an ideal follower stops accelerating at once at the switching speed to enlarge its gap, but
// the controller switches smoothly, so gaps grow later.
TEST(IdealPlatoon, IsCloseToTheSimulatedPlatoon) {
    const SingleLightReport result = run_single_light(load_scenario(scenario_directory() / "single_light.yaml"));
    for (const PopulationSummary& summary : result.populations) {
        const bool switches = summary.name.starts_with("SWITCH");
        for (const double green_s : result.scenario.measure.green_s) {
            const double excess = summary.counter.interpolated(green_s) - summary.ideal.interpolated(green_s);
            EXPECT_GT(excess, -0.5) << summary.name << " at " << green_s << " s";
            EXPECT_LT(excess, switches ? 1.3 : 0.5) << summary.name << " at " << green_s << " s";
        }
    }
}

}  // namespace
}  // namespace stopline
