// Vehicles that are put on a lane, when they enter between two intersections or are moved on: they can stop for what is ahead.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "runs/network/network_run.h"
#include "scenario/load_scenario.h"
#include "sim/state/vehicles/full_group.h"

namespace stopline {
namespace {

NetworkResult figures_of(const std::string& text) { return run_network(parse_scenario(text, "test.yaml"), 0); }

// Who has turned right stands just beyond the end of a link of 19 m.
TEST(PutOnLane, ALinkIsEnteredBehindWhoStandsBeyondIt) {
    const NetworkResult figures = figures_of(
        "duration: 300 s\n"
        "network: {kind: grid, intersection: {lanes: [{movements: straight}, {movements: right}]}, grid: {rows: 2, "
        "row_spacing: 59.1 m}}\n"
        "demand: {kind: saturated, approaches: [c0r0_north]}\n"
        "driver: {base: startup_kit, stop: {decision_deceleration: 7 m/s2}}\n"
        "populations: [CTG-Ref]\n");
    EXPECT_GT(figures.entered, 50);
    EXPECT_EQ(figures.violations.overlaps, 0);
    EXPECT_LT(figures.violations.forced_red_entries, figures.entered / 20);
}

// Links so short that nobody stops on them from the limit.
TEST(PutOnLane, WhoIsMovedOnCanStopAtTheNextLight) {
    const NetworkResult figures = figures_of(
        "duration: 900 s\n"
        "fidelity: meso\n"
        "network: {kind: grid, intersection: {radius: 25 m, speed_limit: 120 km/h}, grid: {columns: 5, column_spacing: "
        "141.2 m}}\n"
        "signal: {green: 0.1 s, cross_green: 10 s}\n"
        "rules: {teleport_cycles: 1}\n"
        "driver: {base: startup_kit, stop: {decision_deceleration: 7 m/s2}}\n"
        "populations: [CTG-Ref]\n");
    EXPECT_GT(figures.delays.teleported, 10);
    EXPECT_EQ(figures.violations.conflicts, 0);
    EXPECT_EQ(figures.violations.forced_red_entries, 0);
    EXPECT_TRUE(figures.violations.none());
}

// Told on yellow, with all that the brakes give, to stop at the end of the shortest link.
TEST(PutOnLane, WhoStopsBarelyOnYellowIsNoViolation) {
    const NetworkResult figures = figures_of(
        "network: {kind: grid, intersection: {radius: 40 m}, grid: {rows: 2, row_spacing: 98.6 m}}\n"
        "signal: {green: 30 s}\n"
        "demand: {kind: saturated}\n"
        "driver: {base: startup_kit, stop: {decision_deceleration: 7 m/s2}}\n"
        "populations: [CTG-Ref]\n");
    EXPECT_EQ(figures.violations.red_entries, 0);
    EXPECT_GT(figures.violations.forced_red_entries, 0);
}

// More vehicles than fit on the longest lane one behind the other are told of as overlaps: there is memory for them.
TEST(PutOnLane, AGroupGrows) {
    FullGroupArrays arrays;
    arrays.resize(16);
    arrays.reserve(200);
    const FullGroup group = arrays.streams();
    EXPECT_GE(group.acceleration - group.speed, 200);
    std::fill_n(group.speed, 200, 2.0F);
    EXPECT_EQ(group.acceleration[0], 1.0F);
}

}  // namespace
}  // namespace stopline
