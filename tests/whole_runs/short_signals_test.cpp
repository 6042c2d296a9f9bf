// Regression tests: in an earlier version two vehicles were in one conflict area in these runs, or vehicles entered on
// red although they could have stopped. The phases of the signals are shorter than the vehicles need, so vehicles that
// cannot stop pass on yellow or red. A random search found these runs.
#include <gtest/gtest.h>

#include <string>

#include "runs/network/network_run.h"
#include "scenario/load_scenario.h"

namespace stopline {
namespace {

// Expects no violation, at least 40 vehicles that exit, and at least `forced` vehicles that pass on red because they
// cannot stop.
void expect_clean_run(const std::string& text, std::int64_t forced) {
    const NetworkResult result = run_network(parse_scenario(text, "test.yaml"), 0);
    EXPECT_GE(result.exited, 40);
    EXPECT_EQ(result.violations.overlaps, 0);
    EXPECT_EQ(result.violations.conflicts, 0);
    EXPECT_EQ(result.violations.red_entries, 0);
    EXPECT_GE(result.violations.forced_red_entries, forced) << "every vehicle could stop";
}

// Lorries of 18 m pass the line at 50 km/h on red, and crossing vehicles have green at the same moment.
TEST(ShortSignals, CrossingVehiclesWaitForThoseThatCannotStop) {
    expect_clean_run(R"(
duration: 140 s
policies: [{name: P, law: constant_distance, standstill_gap: 10 m}]
populations: [{name: X, components: [{policy: P, share: 55 %}, {policy: SWITCH-1, share: 45 %}]}]
vehicle: {base: electric_100kw, length: 18 m}
signal: {first_green: 1 s, yellow: 0 s, all_red: 0 s}
network:
  kind: grid
  intersection:
    lanes: [{movements: straight+left}, {movements: straight}, {movements: straight+right}]
    radius: 13 m
    approach_length: 155 m
)",
                     1);
}

TEST(ShortSignals, CrossingVehiclesWaitInTheMesoscaleModeToo) {
    expect_clean_run(R"(
fidelity: meso
policies:
- {name: P, law: switch_distance, standstill_gap: 6 m, switch_speed: 20 km/h, reference_speed: 50 km/h, reference_gap: 6.36 m}
populations: [P]
vehicle: {base: diesel_eu4_103kw, length: 12 m}
demand: {right: 45 %}
signal: {green: 2 s, yellow: 1 s, all_red: 0 s, offset: 1 s}
network: {kind: grid, intersection: {radius: 10 m}, grid: {columns: 3, rows: 3}}
)",
                     5);
}

// A green of 1 s ends while the first vehicle of the queue accelerates, half a metre before the line.
TEST(ShortSignals, StartingVehicleThatCannotStopIsNotChosenToStop) {
    expect_clean_run(R"(
populations: [{name: X, components: [{policy: CTG-Ref, share: 87 %}, {policy: CDG, share: 13 %}]}]
signal: {green: 1 s, yellow: 0 s, all_red: 1 s}
network: {kind: grid}
rules: {pass_blocker_greens: 2}
)",
                     20);
}

}  // namespace
}  // namespace stopline
