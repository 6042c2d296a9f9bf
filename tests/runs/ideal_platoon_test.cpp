// The ideal platoon against closed forms, and the simulated one against it.
#include "runs/single_light/ideal_platoon.h"

#include <gtest/gtest.h>

#include <cmath>

#include "runs/single_light/single_light.h"
#include "scenario/load_scenario.h"

namespace stopline {
namespace {

constexpr double kLength_m = 5.15;

GapPolicySettings policy(const std::string& law, double time_gap_s) {
    GapPolicySettings settings;
    settings.law = law;
    settings.time_gap_s = time_gap_s;
    return settings;
}

// Behind a leader that is at its speed v at once, a follower with gap s0 + h v nears it as v (1 - exp(-t / h)), the k-th one as a
// chain of k such lags; fronts then pass with the headway (length + s0 + h v) / v.
TEST(IdealPlatoon, ATimeGapIsAChainOfLags) {
    const GapPolicySettings time_gap = policy("constant_time", 0.87);
    const double v = 12.0;
    const double h = time_gap.time_gap_s;
    const std::vector<SpeedSample> leader{{0.0, v}};
    const double line_m = 100.0;
    const std::vector<double> times_s =
        ideal_passages_s(leader, {&time_gap, &time_gap, &time_gap}, kLength_m, line_m, 60.0);
    ASSERT_EQ(times_s.size(), 3U);
    EXPECT_NEAR(times_s[0], line_m / v, 1e-9);
    // Until it drives with v, the k-th follower loses v h in all for each lag: its front is behind by length + s0 + h v.
    const double headway_s = (kLength_m + time_gap.standstill_gap_m + h * v) / v;
    EXPECT_NEAR(times_s[1] - times_s[0], headway_s, 2e-3);
    EXPECT_NEAR(times_s[2] - times_s[1], headway_s, 2e-3);
    // At the start: x(t) = v (t - h (1 - exp(-t / h))) is 1 m at the time below.
    const double t = 0.453;
    const double start_m = v * (t - h * (1.0 - std::exp(-t / h)));
    const std::vector<double> early_s = ideal_passages_s(leader, {&time_gap, &time_gap}, kLength_m,
                                                         start_m - kLength_m - time_gap.standstill_gap_m, 60.0);
    ASSERT_FALSE(early_s.empty());
    EXPECT_NEAR(early_s.back(), t, 0.01);
}

TEST(IdealPlatoon, AConstantDistanceMovesAsOneBody) {
    const GapPolicySettings distance = policy("constant_distance", 0.0);
    const std::vector<SpeedSample> leader{{0.0, 0.0}, {10.0, 15.0}};  // 1.5 m/s2, then 15 m/s
    const std::vector<double> times_s = ideal_passages_s(leader, std::vector(20, &distance), kLength_m, 0.5, 60.0);
    ASSERT_EQ(times_s.size(), 20U);
    for (std::size_t k = 0; k < times_s.size(); ++k) {
        const double way_m = 0.5 + static_cast<double>(k) * (kLength_m + distance.standstill_gap_m);
        const double time_s = way_m < 75.0 ? std::sqrt(way_m / 0.75) : 10.0 + (way_m - 75.0) / 15.0;
        EXPECT_NEAR(times_s[k], time_s, 0.01) << k;
    }
}

TEST(IdealPlatoon, StaysWhereItsLeaderStays) {
    const GapPolicySettings time_gap = policy("constant_time", 0.87);
    EXPECT_TRUE(ideal_passages_s({}, {&time_gap, &time_gap}, kLength_m, 0.5, 60.0).empty());
    EXPECT_TRUE(ideal_passages_s({}, {}, kLength_m, 0.5, 60.0).empty());
}

// What controller and powertrain change: less than a vehicle, up to 30 s of green. Where a policy switches, its ideal would drop the
// acceleration to nothing at once; the controller switches without a bump, so that its gaps grow later and it passes more.
TEST(IdealPlatoon, IsWhatTheSimulatedOneComesNearTo) {
    const SingleLightReport result = run_single_light(load_scenario(data_directory() / "../scenarios/single_light.yaml"));
    for (const PopulationSummary& summary : result.populations) {
        const bool switches = summary.name.starts_with("SWITCH");
        for (const double green_s : result.scenario.measure.green_s) {
            const double more = summary.counter.interpolated(green_s) - summary.ideal.interpolated(green_s);
            EXPECT_GT(more, -0.5) << summary.name << " at " << green_s << " s";
            EXPECT_LT(more, switches ? 1.3 : 0.5) << summary.name << " at " << green_s << " s";
        }
    }
}

}  // namespace
}  // namespace stopline
