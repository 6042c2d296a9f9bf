// Gaps in the queue of a single light at the start of green. A vehicle has closed up if its net gap is near its own
// standstill gap.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "runs/single_light/single_light.h"
#include "scenario/scenario_text.h"

namespace stopline {
namespace {

QueueGaps gaps_of(const std::string& fidelity, const std::string& first_green, const std::string& policy) {
    const std::string mix =
        "{name: MIX, pattern: alternating, components: [{policy: CDG, share: 50 %}, {policy: " + policy +
        ", share: 50 %}]}";
    const SingleLightReport report = run_single_light(
        parse_scenario("{fidelity: " + fidelity +
                           ", network: {approach: {length: 600 m}}, demand: {vehicles: 20}, duration: 260 s, "
                           "signal: {first_green: " +
                           first_green + ", green: 20 s}, populations: [" + mix + "], measure: {green: [10 s]}}",
                       "test.yaml"));
    return report.populations.at(0).queue;
}

class QueueGapsOfAMix : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Fidelities, QueueGapsOfAMix, ::testing::Values("meso", "full"));

TEST_P(QueueGapsOfAMix, AreClosedInAStandingQueue) {
    const QueueGaps gaps = gaps_of(GetParam(), "180 s", "CDG-6m");
    EXPECT_NEAR(gaps.smallest_m, 2.95, 0.1);
    EXPECT_NEAR(gaps.largest_m, 6.0, 0.1);
    EXPECT_TRUE(std::isnan(gaps.largest_open_m)) << gaps.largest_open_m;
    EXPECT_TRUE(std::isnan(gaps_of(GetParam(), "220 s", "HUMAN").largest_open_m));
}

TEST_P(QueueGapsOfAMix, AreOpenWhileVehiclesArrive) {
    const QueueGaps gaps = gaps_of(GetParam(), "40 s", "CDG-6m");
    EXPECT_GT(gaps.largest_open_m, 7.0);
    EXPECT_DOUBLE_EQ(gaps.largest_open_m, gaps.largest_m);
}

}  // namespace
}  // namespace stopline
