// Full dynamics: junctions that are blocked for long, since drivers do not keep them clear, and fast turns. In each of these runs two vehicles
// once met. Found among random ones.
#include <gtest/gtest.h>

#include <string>

#include "experiment/network_run.h"
#include "scenario/load_scenario.h"

namespace stopline {
namespace {

void expect_nobody_meets(const std::string& text) {
    const NetworkFigures figures = run_network(parse_scenario(text, "test.yaml"), 0);
    EXPECT_GT(figures.left_network, 50);
    EXPECT_EQ(figures.violations.overlaps, 0);
    EXPECT_EQ(figures.violations.conflicts, 0);
    EXPECT_TRUE(figures.violations.none());
}

// One that just comes through the speed at which its time gap begins, nearer than it wants, behind one that brakes with all it has.
TEST(CrowdedJunctions, SwitchingPoliciesStopBehindAnEmergency) {
    expect_nobody_meets(R"(
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

// A left turner sets out, and so does one with priority that waits for somebody beyond the beginning of the area that they share.
TEST(CrowdedJunctions, WhoWaitsInsideAnAreaDoesNotWaitBeforeIt) {
    expect_nobody_meets(R"(
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

// One that has stood in the junction sets out before a left turner that took that for its gap and cannot stop any more.
TEST(CrowdedJunctions, WhoSetsOutMindsWhoCannotStop) {
    expect_nobody_meets(R"(
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

}  // namespace
}  // namespace stopline
