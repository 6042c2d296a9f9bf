// The saturation flow is a property of the queue, not of the demand: vehicles that arrive when the queue has left do
// not count.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "runs/intersection/intersection_run.h"
#include "scenario/scenario_text.h"

namespace stopline {
namespace {

Discharge discharge_of(const std::string& population, const std::string& demand) {
    const IntersectionResult result = run_intersection(
        parse_scenario("{network: {kind: intersection, intersection: {approach_length: 500 m}}, signal: {first_green: "
                       "1 s, green: 20 s}, demand: " +
                           demand + ", duration: 0 s, populations: [" + population + "], measure: {cycles: 10}}",
                       "test.yaml"),
        0);
    EXPECT_TRUE(result.violations.none());
    EXPECT_GT(result.queue_veh, 2.0) << "no queue stood";
    return result.discharge;
}

constexpr const char* kWeakDemand = "{kind: rate, inflow: 900 veh/h}";

TEST(UnsaturatedRun, HasTheSaturationFlowOfAQueue) {
    const Discharge weak = discharge_of("CTG-Ref", kWeakDemand);
    const Discharge saturated = discharge_of("CTG-Ref", "{kind: saturated}");
    EXPECT_LT(weak.vehicles_per_green, 0.7 * saturated.vehicles_per_green) << "the weak demand is too high";
    ASSERT_GT(weak.saturated_greens, 0);
    // The headways still fall slightly after the fifth vehicle, so short queues have a lower flow than long ones.
    EXPECT_NEAR(weak.saturation_flow_veh_h, saturated.saturation_flow_veh_h, 0.15 * saturated.saturation_flow_veh_h);
    EXPECT_GT(weak.startup_lost_time_s, 0.5);
    EXPECT_LT(weak.startup_lost_time_s, 3.0);
}

// With a constant distance gap (CDG) a queue starts so fast that it has left before a fifth vehicle stops. A saturation
// flow needs a fifth vehicle.
TEST(UnsaturatedRun, HasNoSaturationFlowIfNoQueueIsLongEnough) {
    const Discharge weak = discharge_of("CDG", kWeakDemand);
    EXPECT_EQ(weak.saturated_greens, 0);
    EXPECT_TRUE(std::isnan(weak.saturation_flow_veh_h));
    EXPECT_TRUE(std::isnan(weak.startup_lost_time_s));
    EXPECT_GT(weak.vehicles_per_green, 5.0) << "too few vehicles pass to fill a queue";
}

}  // namespace
}  // namespace stopline
