// However short the critical gap of a driver is, a vehicle with priority must be able to stop. With a critical gap of
// 0 s, left-turning vehicles must not enter directly in front of oncoming vehicles.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "runs/intersection/intersection_run.h"
#include "scenario/load_scenario.h"

namespace stopline {
namespace {

class CriticalGap : public ::testing::TestWithParam<const char*> {};

TEST_P(CriticalGap, OfZeroLeavesTimeToStop) {
    const std::string text = fmt::format(R"(
fidelity: {}
step: 20 ms
seed: 7
duration: 100 s
network: {{kind: intersection, intersection: {{turn_speed: 11 m/s, approach_length: 150 m}}}}
signal: {{first_green: 1 s, green: 20 s}}
measure: {{warmup_cycles: 0}}
demand: {{kind: saturated, left: 40 %, right: 20 %}}
vehicle: diesel_eu4_103kw
driver: {{base: startup_kit, give_way: {{critical_gap: 0 s}}}}
populations: [CTG-Ref]
)",
                                         GetParam());
    const IntersectionResult result = run_intersection(parse_scenario(text, "test.yaml"), 0);
    EXPECT_GT(result.gaps_accepted, 10);
    EXPECT_EQ(result.violations.conflicts, 0);
    EXPECT_TRUE(result.violations.none());
}

INSTANTIATE_TEST_SUITE_P(Fidelities, CriticalGap, ::testing::Values("meso", "full"),
                         [](const auto& fidelity) { return std::string(fidelity.param); });

// A left-turning vehicle accepts a gap while the vehicle before the gap is still in its way. It starts a step later.
// The next vehicle with priority must then still be able to stop.
TEST(KeptGap, LeavesTimeToStop) {
    const Scenario scenario = parse_scenario(R"(
fidelity: meso
meso: fitted
network: {kind: intersection}
demand: {left: 11 %}
driver: {base: startup_kit, give_way: {critical_gap: 0 s}}
populations: [CTG-Ref]
)",
                                             "test.yaml");
    const IntersectionResult result = run_intersection(scenario, 0);
    EXPECT_GT(result.gaps_accepted, 10);
    EXPECT_TRUE(result.violations.none());
}

}  // namespace
}  // namespace stopline
