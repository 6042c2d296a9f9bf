// Regression tests: an earlier version had a collision of two vehicles in each of these runs. In some runs junctions
// are blocked for long, because drivers do not keep them clear. In other runs junctions are close together or have fast
// turns. A random search found these runs.
#include <gtest/gtest.h>

#include <string>

#include "runs/network/network_run.h"
#include "scenario/load_scenario.h"

namespace stopline {
namespace {

void expect_no_violations(const std::string& text) {
    const NetworkResult result = run_network(parse_scenario(text, "test.yaml"), 0);
    EXPECT_GT(result.exited, 50);
    EXPECT_EQ(result.violations.overlaps, 0);
    EXPECT_EQ(result.violations.conflicts, 0);
    EXPECT_TRUE(result.violations.none());
}

// The leader brakes with its maximum. The follower's speed is just above the switching speed of its policy, and its gap
// is still shorter than the desired gap.
TEST(CrowdedJunctions, SwitchingPoliciesStopBehindEmergencyBraking) {
    expect_no_violations(R"(
duration: 460 s
seed: 1337
network:
  kind: grid
  intersection: {lanes: [{movements: left}, {movements: straight+right}], radius: 25 m, turn_speed: 10.10 m/s}
  grid: {rows: 3, columns: 2, row_spacing: 178.97 m, column_spacing: 117.91 m}
signal: {green: 15 s}
demand: {kind: saturated, right: 20 %}
rules: {teleport_cycles: 3, pass_blocker_greens: 2}
driver: {base: startup_kit, stop: {decision_deceleration: 7 m/s2}}
populations: [SWITCH-1]
)");
}

// As in the previous test, but the desired gap grows so fast with speed that the actual gap is far below it.
TEST(CrowdedJunctions, FollowersDoNotRelyOnAGapStillMissing) {
    expect_no_violations(R"(
duration: 172 s
step: 10 ms
seed: 41035
network:
  kind: grid
  intersection:
    lanes: [{movements: straight+left}, {movements: straight}, {movements: straight+right}]
    radius: 25 m
    speed_limit: 80 km/h
    turn_speed: 12.08 m/s
  grid: {rows: 3, columns: 2, row_spacing: 186.08 m, column_spacing: 142.07 m}
signal: {green: 20 s, yellow: 4 s}
demand: {kind: saturated, right: 50 %, left: 50 %, order: random}
rules: {teleport_cycles: 3}
vehicle: diesel_eu4_103kw
driver:
  base: startup_kit
  stop: {decision_deceleration: 7 m/s2}
  give_way: {critical_gap: 6 s}
  free_drive: {hesitation: 0.5 s}
policies:
- {name: STEEP, law: switch_distance, standstill_gap: 2 m, switch_speed: 25 km/h, reference_speed: 50 km/h, reference_gap: 25 m}
populations: [STEEP]
)");
}

// Vehicle A has priority over the left-turning vehicle L, but yields to vehicle B. The position where A waits for B is
// inside the conflict area of A and L. A and L start at the same time, so L must expect that A enters this area.
TEST(CrowdedJunctions, VehicleYieldingInsideAnAreaStillEntersIt) {
    expect_no_violations(R"(
duration: 397 s
seed: 61168
network:
  kind: grid
  intersection:
    lanes: [{movements: straight+left}, {movements: straight}, {movements: straight+right}]
    speed_limit: 30 km/h
    turn_speed: 6.30 m/s
  grid: {rows: 1, columns: 3, row_spacing: 138.77 m, column_spacing: 126.85 m}
signal: {green: 20 s, yellow: 4 s, all_red: 2 s, offset: 10 s}
demand: {kind: saturated, right: 30 %, left: 5 %}
rules: {teleport_cycles: 3}
driver: {base: startup_kit, stop: {decision_deceleration: 7 m/s2}}
populations: [SWITCH-1]
)");
}

// A left-turning vehicle has accepted a gap, because a vehicle with priority is stopped in the junction. When the
// stopped vehicle starts, the left-turning vehicle can no longer stop. The starting vehicle must let it pass.
TEST(CrowdedJunctions, StartingVehicleYieldsToOneThatCannotStop) {
    expect_no_violations(R"(
duration: 364 s
seed: 62261
network:
  kind: grid
  intersection: {lanes: [{movements: left}, {movements: straight+right}], radius: 15 m, speed_limit: 60 km/h, turn_speed: 11.40 m/s}
  grid: {rows: 1, columns: 2, row_spacing: 117.78 m, column_spacing: 75.93 m}
signal: {green: 15 s, offset: 10 s}
demand: {kind: rate, inflow: 400 veh/h, right: 0 %}
rules: {teleport_cycles: 3}
driver: {base: startup_kit, stop: {decision_deceleration: 7 m/s2}}
policies:
- {name: S-SHORT, law: switch_time_gap, standstill_gap: 2.95 m, time_gap: 0.4 s, switch_speed: 36 km/h}
populations: [S-SHORT]
)");
}

// A left-turning vehicle has accepted a gap and started. Then another vehicle inside the junction makes the gap too
// short. The left-turning vehicle has barely room to stop, and its brakes lag, so it must not try to stop.
TEST(CrowdedJunctions, VehicleThatMayStopTooLateKeepsItsGap) {
    expect_no_violations(R"(
duration: 456 s
step: 5 ms
seed: 44417
network:
  kind: grid
  intersection:
    lanes: [{movements: straight+left}, {movements: straight+right}]
    radius: 12 m
    turn_speed: 12.96 m/s
  grid: {rows: 2, columns: 3, row_spacing: 63.88 m, column_spacing: 166.1 m}
signal: {green: 8 s, yellow: 4 s, all_red: 2 s, offset: 5 s}
demand: {kind: saturated, right: 5 %, left: 50 %}
rules: {pass_blocker_greens: 2}
vehicle: {base: petrol_eu4_72kw, length: 12 m}
driver:
  base: startup_kit
  stop: {decision_deceleration: 3.5 m/s2}
  give_way: {critical_gap: 3 s}
  free_drive: {hesitation: 0 s}
policies:
- {name: SHORT, law: constant_time, standstill_gap: 2 m, time_gap: 0.3 s}
populations: [{name: MIXED, pattern: random, components: [{policy: SHORT, share: 50 %}, {policy: SWITCH-2, share: 50 %}]}]
)");
}

// The rear of a stopped vehicle is on the stretch before the connections diverge. Vehicles from another leg turn into
// the exit lane and hide the stopped vehicle for moments. Meanwhile the vehicle at the stop line must not creep
// forward.
TEST(CrowdedJunctions, VehicleTurningIntoTheExitDoesNotHideAStoppedOne) {
    expect_no_violations(R"(
duration: 382 s
step: 10 ms
seed: 46705
network:
  kind: grid
  intersection:
    lanes: [{movements: straight+left}, {movements: straight+right}]
    radius: 15 m
    speed_limit: 30 km/h
    turn_speed: 8.23 m/s
  grid: {rows: 3, columns: 2, row_spacing: 209.66 m, column_spacing: 109.55 m}
signal: {green: 30 s, offset: 10 s}
demand: {kind: saturated, right: 20 %, left: 50 %}
rules: {pass_blocker_greens: 2}
vehicle: {base: petrol_eu4_72kw, length: 12 m}
driver:
  base: startup_kit
  stop: {decision_deceleration: 5 m/s2}
  give_way: {critical_gap: 3 s}
  free_drive: {hesitation: 0.5 s}
policies:
- {name: STEEP, law: switch_distance, standstill_gap: 2 m, switch_speed: 25 km/h, reference_speed: 50 km/h, reference_gap: 25 m}
populations: [STEEP]
)");
}

// The links are so short that a vehicle with priority can arrive within the critical gap even if it is still upstream
// of the previous intersection.
TEST(CrowdedJunctions, GapSearchReachesBeyondShortLinks) {
    expect_no_violations(R"(
fidelity: meso
duration: 300 s
step: 10 ms
seed: 3019
network:
  kind: grid
  intersection:
    lanes: [{movements: straight+left+right}, {movements: straight+right}]
    radius: 15 m
    speed_limit: 70 km/h
    turn_speed: 12.23 m/s
  grid: {rows: 3, columns: 3, row_spacing: 77.67 m, column_spacing: 80.32 m}
signal: {green: 30 s}
demand: {kind: rate, inflow: 1500 veh/h, right: 20 %, left: 5 %, order: random}
rules: {teleport_cycles: 3, pass_blocker_greens: 2}
vehicle: {base: petrol_eu4_72kw, length: 12 m}
driver:
  base: startup_kit
  stop: {decision_deceleration: 5 m/s2}
  give_way: {critical_gap: 5 s}
  free_drive: {hesitation: 0 s}
populations: [{name: MIXED, pattern: random, components: [{policy: SWITCH-1, share: 50 %}, {policy: SWITCH-2, share: 50 %}]}]
)");
}

}  // namespace
}  // namespace stopline
