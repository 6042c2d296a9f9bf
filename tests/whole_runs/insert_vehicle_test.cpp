// Vehicles are inserted between two intersections or reinserted after teleporting. They must be able to stop for the
// traffic and the signal ahead.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "runs/network/network_run.h"
#include "runs/single_light/single_light.h"
#include "scenario/load_scenario.h"
#include "sim/state/vehicles/full_group.h"

namespace stopline {
namespace {

NetworkResult result_of(const std::string& text) { return run_network(parse_scenario(text, "test.yaml"), 0); }

// A right-turning vehicle can be stopped just beyond the end of a link of 19 m. A vehicle inserted on the link must
// stop behind it.
TEST(InsertVehicle, KeepsAGapToAVehicleStoppedBeyondTheLink) {
    const NetworkResult result = result_of(
        "duration: 300 s\n"
        "network: {kind: grid, intersection: {lanes: [{movements: straight}, {movements: right}]}, grid: {rows: 2, "
        "row_spacing: 59.1 m}}\n"
        "demand: {kind: saturated, approaches: [c0r0_north]}\n"
        "driver: {base: startup_kit, stop: {decision_deceleration: 7 m/s2}}\n"
        "populations: [CTG-Ref]\n");
    EXPECT_GT(result.entered, 50);
    EXPECT_EQ(result.violations.overlaps, 0);
    EXPECT_LT(result.violations.forced_red_entries, result.entered / 20);
}

// A vehicle of 30 m whose front has left an approach of 32 m still covers most of it.
TEST(InsertVehicle, KeepsAGapToTheRearOfAVehicleThatLeavesAnInlet) {
    const SingleLightReport report =
        run_single_light(parse_scenario("duration: 60 s\n"
                                        "network: {approach: {lanes: 1, length: 32 m, exit_length: 50 m}}\n"
                                        "signal: {first_green: 5 s, green: 30 s}\n"
                                        "vehicle: {base: petrol_eu4_72kw, length: 30 m}\n"
                                        "demand: {kind: saturated, start: queued}\n"
                                        "populations: [CTG-Ref]\n",
                                        "test.yaml"));
    EXPECT_TRUE(report.no_violations());
}

// The rear of a lorry of 16.5 m that waits beyond a link is still on the link.
TEST(InsertVehicle, TeleportedVehicleKeepsAGapToARearOnItsLane) {
    for (const char* const cycles : {"0.2", "1"}) {
        const NetworkResult result = result_of(
            std::string("duration: 600 s\n"
                        "network: {kind: grid, intersection: {radius: 12 m, speed_limit: 20 km/h, turn_speed: 1 m/s, "
                        "approach_length: 60 m, exit_length: 30 m, lanes: [{movements: straight+left+right}]}, grid: "
                        "{columns: 1, rows: 2, row_spacing: 50 m}}\n"
                        "signal: {first_green: 0 s, green: 4 s, yellow: 1 s, all_red: 2 s}\n"
                        "demand: {kind: rate, inflow: 500 veh/h, left: 20 %, right: 50 %, entry_speed: 20 km/h}\n"
                        "vehicle: articulated_lorry_35t\n"
                        "driver: lorry\n"
                        "populations: [CTG-Ref]\n"
                        "measure: {window: 300 s}\n"
                        "rules: {teleport_cycles: ") +
            cycles + "}\n");
        EXPECT_GT(result.delays.teleported, 0) << cycles;
        EXPECT_EQ(result.violations.overlaps, 0) << cycles;
    }
}

// The links are too short to stop from the speed limit before the next signal, so teleported vehicles must be inserted
// at a lower speed.
TEST(InsertVehicle, TeleportedVehicleCanStopAtTheNextSignal) {
    const NetworkResult result = result_of(
        "duration: 900 s\n"
        "fidelity: meso\n"
        "network: {kind: grid, intersection: {radius: 25 m, speed_limit: 120 km/h}, grid: {columns: 5, column_spacing: "
        "141.2 m}}\n"
        "signal: {green: 0.1 s, cross_green: 10 s}\n"
        "rules: {teleport_cycles: 1}\n"
        "driver: {base: startup_kit, stop: {decision_deceleration: 7 m/s2}}\n"
        "populations: [CTG-Ref]\n");
    EXPECT_GT(result.delays.teleported, 10);
    EXPECT_EQ(result.violations.conflicts, 0);
    EXPECT_EQ(result.violations.forced_red_entries, 0);
    EXPECT_TRUE(result.violations.none());
}

// On links as short as this one, vehicles need maximum braking to stop on yellow. A vehicle that shifts down meanwhile
// loses braking. A vehicle that therefore overruns the stop line is counted as a forced red entry, not as a violation.
TEST(InsertVehicle, OverrunOnYellowIsNoViolation) {
    const NetworkResult result = result_of(
        "network: {kind: grid, intersection: {radius: 40 m}, grid: {rows: 2, row_spacing: 98.6 m}}\n"
        "signal: {green: 30 s}\n"
        "demand: {kind: saturated}\n"
        "vehicle: diesel_eu4_103kw\n"
        "driver: {base: startup_kit, stop: {decision_deceleration: 7 m/s2}}\n"
        "populations: [CTG-Ref]\n");
    EXPECT_EQ(result.violations.red_entries, 0);
    EXPECT_GT(result.violations.forced_red_entries, 0);
}

// Overlapping vehicles can make a lane hold more vehicles than it has room for. The arrays for a group of lanes must
// then grow, so that the run can go on and report the overlaps.
TEST(FullGroup, GrowsBeyondThePlannedSize) {
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
