// Full dynamics: a follower brakes for a stopped vehicle on its own route that a diverging leader hides.
#include <gtest/gtest.h>

#include <string>

#include "runs/network/network_run.h"
#include "scenario/load_scenario.h"

namespace stopline {
namespace {

// The link between the two intersections is only 41 m long (81.27 m minus twice the radius of 20 m). The queue at the
// second signal fills it. A right-turning leader hides this queue from a follower that goes straight on into the link.
// At these turn speeds the leader hardly brakes for its turn, so the follower arrives fast.
TEST(HiddenLeaders, FollowerStopsForAVehicleHiddenByATurningLeader) {
    for (const char* const turn_speed : {"9 m/s", "12 m/s", "50 km/h"}) {
        const std::string text =
            "duration: 300 s\n"
            "network: {kind: grid, intersection: {turn_speed: " +
            std::string(turn_speed) +
            "}, grid: {rows: 2, row_spacing: 81.27 m}}\n"
            "demand: {kind: saturated, right: 20 %}\n"
            "populations: [SWITCH-1, SWITCH-2, CDG]\n";
        const Scenario scenario = parse_scenario(text, "test.yaml");
        for (std::size_t population = 0; population < 3; ++population) {
            const NetworkResult result = run_network(scenario, population);
            EXPECT_GT(result.exited, 100) << turn_speed << population;
            EXPECT_EQ(result.violations.overlaps, 0) << turn_speed << population;
            EXPECT_TRUE(result.violations.none()) << turn_speed << population;
        }
    }
}

}  // namespace
}  // namespace stopline
