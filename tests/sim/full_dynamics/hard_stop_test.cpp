// The smallest accepted standstill gap must cover a hard stop of a whole chain of vehicles, with the longest accepted
// lags.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "scenario/driving_checks.h"
#include "support/track.h"

namespace stopline {
namespace {

using namespace testing_support;

struct Law {
    const char* name;
    const char* fields;
    const char* driver = "driver.human.reaction=1 s";
};

class HardStop : public testing::TestWithParam<Law> {};
INSTANTIATE_TEST_SUITE_P(
    EveryLaw, HardStop,
    testing::Values(Law{"distance", "law: constant_distance"}, Law{"no_time", "law: constant_time, time_gap: 0 s"},
                    Law{"short_time", "law: constant_time, time_gap: 0.3 s"},
                    Law{"switch_time", "law: switch_time_gap, time_gap: 0.87 s, switch_speed: 20 km/h"},
                    Law{"switch_steep",
                        "law: switch_distance, switch_speed: 30 km/h, reference_speed: 31 km/h, "
                        "reference_gap: 16 m"},
                    Law{"human_no_time", "law: human, time_gap: 0 s"},
                    Law{"human_late", "law: human, time_gap: 0.38 s", "driver.human.reaction=2 s"}),
    [](const testing::TestParamInfo<Law>& law) { return std::string(law.param.name); });

struct Stop {
    double smallest_gap_m = 1e9;
    double hardest_mps2 = 0.0;
};

// Vehicles start from a queue. The light turns red after `green_s`, when the vehicles have reached their speed. The
// first vehicle that can stop brakes for the red light.
Stop stop_at_end_of_green(const std::string& vehicle, const Law& law, double green_s) {
    TrackPlan plan;
    plan.vehicle = vehicle;
    plan.policy = "P";
    plan.length_m = 800.0;
    plan.green_s = green_s;
    plan.overrides = {std::string("policies=[{name: P, standstill_gap: 2 m, ") + law.fields + "}]",
                      "populations=[P]",
                      "measure.baseline=P",
                      "demand.vehicles=1",
                      "driver.stop.decision_deceleration=6 m/s2",
                      law.driver};
    Scenario scenario = scenario_of(plan);
    scenario.signal.yellow_s = 0.0;
    EXPECT_EQ(scenario.policies.back().standstill_gap_m, kMinStandstillGap_m);
    Track track(build_model(scenario, 0));
    const double spacing_m = track.model().vehicles[0].length_m + kMinStandstillGap_m;
    constexpr int kVehicles = 25;
    for (int k = 0; k < kVehicles; ++k) track.place(0, plan.length_m - 60.0 - spacing_m * k, 0.0);
    Stop stop;
    while (track.time_s() < green_s + 24.0) {
        track.step();  // checks that no two vehicles overlap
        if (testing::Test::HasFatalFailure()) return stop;
        for (int k = 1; k < track.count(0); ++k) {
            stop.smallest_gap_m = std::min(stop.smallest_gap_m, track.vehicle(0, k).gap_m);
            stop.hardest_mps2 = std::max(stop.hardest_mps2, -track.vehicle(0, k).acceleration_mps2);
        }
    }
    return stop;
}

// The first vehicle that can stop needs full braking only if the light turns red when this vehicle can barely stop. The
// test therefore tries green times that differ by up to the headway of two vehicles, so that one green time is near
// this moment.
TEST_P(HardStop, LeavesAGapToEveryLeader) {
    for (const std::string vehicle : {"petrol_eu4_72kw", "{base: electric_100kw, length: 18 m, brake_lag: 0.5 s}"}) {
        double hardest_mps2 = 0.0;
        for (double green_s = 16.0; green_s < 18.0; green_s += 0.4) {
            const Stop stop = stop_at_end_of_green(vehicle, GetParam(), green_s);
            if (HasFatalFailure()) return;
            EXPECT_GT(stop.smallest_gap_m, 0.1) << vehicle << ", green of " << green_s << " s";
            hardest_mps2 = std::max(hardest_mps2, stop.hardest_mps2);
        }
        EXPECT_GT(hardest_mps2, 5.0) << vehicle << ": no stop is hard";
    }
}

}  // namespace
}  // namespace stopline
