// A platoon that arrives with long gaps at the speed limit must close up. Vehicles that have not closed up yet are not
// in steady state, however long they keep their gaps.
#include <gtest/gtest.h>

#include <string>

#include "runs/single_light/single_light.h"
#include "scenario/scenario_text.h"

namespace stopline {
namespace {

constexpr double kStandstillGap_m = 2.95;

// Vehicles enter one after the other at the limit of 40 km/h, 17 m apart. The light is green when they arrive.
SingleLightReport arriving_platoon(const std::string& fidelity) {
    return run_single_light(parse_scenario(
        "{fidelity: " + fidelity +
            ", network: {approach: {length: 1500 m, speed_limit: 40 km/h}}, signal: {first_green: 60 s, green: 120 s}, "
            "duration: 300 s, demand: {vehicles: 60, entry_speed: 40 km/h}, populations: [CDG, CTG-Ref], "
            "measure: {baseline: CTG-Ref, green: [60 s]}}",
        "test.yaml"));
}

TEST(ArrivingPlatoon, ClosesUpToThePolicyGap) {
    for (const std::string fidelity : {"full", "meso"}) {
        const SingleLightReport result = arriving_platoon(fidelity);
        EXPECT_TRUE(result.no_violations()) << fidelity;
        const SteadyFlow& steady = result.populations[0].steady;
        EXPECT_GE(steady.vehicles, 5) << fidelity << ": too few vehicles have closed up";
        EXPECT_DOUBLE_EQ(steady.policy_gap_m, kStandstillGap_m) << fidelity;
        EXPECT_NEAR(steady.net_gap_m, kStandstillGap_m, 0.3) << fidelity;
    }
}

// Vehicles ahead close up first. Meanwhile the vehicles at the end of the platoon keep a constant, far too large gap.
// They keep it long enough to look steady, but must not count as steady.
TEST(ArrivingPlatoon, VehiclesWithOpenGapsAreCountedApart) {
    for (const std::string fidelity : {"full", "meso"}) {
        const SteadyFlow steady = arriving_platoon(fidelity).populations[0].steady;
        EXPECT_GE(steady.not_closed_up, 5) << fidelity << ": all vehicles have closed up";
        EXPECT_GT(steady.open_gap_m, 10.0) << fidelity;
        EXPECT_LT(steady.deviation_percent, 5.0) << fidelity << ": open gaps count as steady";
    }
}

}  // namespace
}  // namespace stopline
