// The text about a deadlock names the vehicles that wait for each other, and their places.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "runs/intersection/intersection.h"
#include "scenario/load_scenario.h"

namespace stopline {
namespace {

// Vehicles need longer to cross than the signal gives them: turns at 2 m/s, and 1 s between the greens.
constexpr const char* kShortClearance = R"(
fidelity: meso
seed: 4
duration: 150 s
network:
  kind: intersection
  intersection:
    lanes: [{movements: straight+left+right}]
    approach_length: 60 m
    exit_length: 20 m
    radius: 12 m
    turn_speed: 2 m/s
signal: {first_green: 0 s, green: 5 s, yellow: 0 s, all_red: 1 s}
measure: {warmup_cycles: 0}
demand: {kind: saturated, left: 30 %, right: 10 %}
vehicle: {base: petrol_eu4_72kw, length: 5 m}
rules: {keep_clear: off}
populations: [CDG]
)";

TEST(Deadlock, NamesTheVehiclesThatWaitForEachOther) {
    const IntersectionReport report = run_intersections(parse_scenario(kShortClearance, "test.yaml"), {});
    const IntersectionResult& result = report.populations[0];
    EXPECT_EQ(result.violations.deadlocks, 1);
    EXPECT_FALSE(report.no_violations());
    ASSERT_TRUE(result.deadlock);
    const Deadlock& deadlock = *result.deadlock;
    // Two cycles of 12 s are shorter than kMinDeadlock_s. Added is the crossing at 2 m/s.
    EXPECT_GT(deadlock.to_s - deadlock.from_s, kMinDeadlock_s + 24.0 / 2.0);
    EXPECT_LE(deadlock.to_s - deadlock.from_s, result.longest_in_junction_s + 1e-9);
    ASSERT_GE(deadlock.members.size(), 2U);
    EXPECT_EQ(deadlock.members[0].vehicle, deadlock.vehicle);
    EXPECT_EQ(deadlock.members[0].lane, deadlock.lane);
    for (std::size_t k = 1; k < deadlock.members.size(); ++k)
        EXPECT_EQ(deadlock.members[k].vehicle, deadlock.members[k - 1].waits_for);
    // The last one waits for a vehicle that is listed already.
    bool is_ring = false;
    for (const DeadlockMember& member : deadlock.members)
        is_ring = is_ring || member.vehicle == deadlock.members.back().waits_for;
    EXPECT_TRUE(is_ring);
    const std::string text = deadlock_text(deadlock, report.lanes);
    EXPECT_EQ(
        text.find(fmt::format(
            "vehicle {} on {} has neither left the intersection nor yielded to moving traffic from {:.1f} s to {:.1f} s.\n",
            deadlock.vehicle, report.lanes[static_cast<std::size_t>(deadlock.lane)], deadlock.from_s, deadlock.to_s)),
        0U)
        << text;
    EXPECT_NE(text.find(fmt::format("  vehicle {} on ", deadlock.members[1].vehicle)), std::string::npos) << text;
    EXPECT_NE(text.find(fmt::format("waits for vehicle {} (junction_blocking)\n", deadlock.members[1].vehicle)),
              std::string::npos)
        << text;
}

TEST(Deadlock, IsAbsentWithTimeToClearTheIntersection) {
    const Scenario scenario = parse_scenario(kShortClearance, "test.yaml", {"signal.all_red=15 s"});
    const IntersectionReport report = run_intersections(scenario, {});
    EXPECT_FALSE(report.populations[0].deadlock);
    EXPECT_TRUE(report.no_violations());
}

// A permissive left-turning vehicle waits inside the intersection while oncoming traffic extends the green. The nominal
// cycle is 36 s, the longest one 126 s.
TEST(Deadlock, WaitingInALongGreenIsNone) {
    const IntersectionReport report = run_intersections(parse_scenario(R"(
fidelity: meso
network: {kind: intersection, intersection: {lanes: [{movements: left}, {movements: straight+right}]}}
signal:
  controller: actuated
  first_green: 1 s
  phases:
  - {protected: [west_straight, east_straight, west_right, east_right], permissive: [west_left, east_left],
     green: 10 s, max_green: 90 s}
  - {protected: [south_straight, north_straight, south_right, north_right], permissive: [south_left, north_left],
     green: 10 s, max_green: 20 s}
demand: {kind: saturated, cross_inflow: 300 veh/h}
populations: [CTG-Ref]
measure: {warmup_cycles: 0, cycles: 10}
)",
                                                                       "test.yaml"),
                                                        {});
    const IntersectionResult& result = report.populations[0];
    EXPECT_GT(result.longest_in_junction_s, 2.0 * 36.0 + 10.0);
    EXPECT_EQ(result.violations.deadlocks, 0);
}

// Almost no vehicle calls the second phase, so the green of the first one goes on for far more than two of the longest
// cycles. The left-turning vehicle inside the intersection gets no gap in the saturated oncoming traffic: it starves.
TEST(Deadlock, YieldingInAGreenWithoutEndIsStarvation) {
    const IntersectionReport report = run_intersections(parse_scenario(R"(
fidelity: meso
network: {kind: intersection, intersection: {lanes: [{movements: left}, {movements: straight+right}]}}
signal:
  controller: actuated
  first_green: 1 s
  phases:
  - {protected: [west_straight, east_straight, west_right, east_right], permissive: [west_left, east_left],
     green: 10 s, max_green: 20 s}
  - {protected: [south_straight, north_straight, south_right, north_right], permissive: [south_left, north_left],
     green: 10 s, max_green: 20 s}
demand: {kind: saturated, cross_inflow: 1 veh/h}
populations: [CTG-Ref]
measure: {warmup_cycles: 0, cycles: 15}
)",
                                                                       "test.yaml"),
                                                        {});
    const IntersectionResult& result = report.populations[0];
    EXPECT_GT(result.longest_in_junction_s, 300.0);
    EXPECT_EQ(result.violations.deadlocks, 0);
    EXPECT_TRUE(report.no_violations());
    EXPECT_GT(result.starvations.size(), 0U);
}

}  // namespace
}  // namespace stopline
