// Speed limits in the mesoscale mode: vehicles approach a lower speed with comfortable braking, close up to leaders at
// the limit, and accelerate on fast roads.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>

#include "scenario/load_scenario.h"
#include "sim/step/simulation.h"
#include "support/track.h"

namespace stopline {
namespace {

using namespace testing_support;

// Runs an imported network. Returns the hardest braking of any vehicle, m/s2. Stores the speed range of the run.
double hardest_braking_mps2(const std::string& name, double& lowest_mps, double& highest_mps,
                            const std::string& step = "0.1 s") {
    const std::string data = STOPLINE_SOURCE_DIR "/tests/data/" + name;
    const Scenario scenario = parse_scenario(
        "{fidelity: meso, duration: 120 s, meso: table2, populations: [CTG-Ref], network: {kind: sumo, net: " + data +
            ".net.xml, routes: [" + data + ".rou.xml]}}",
        "test.yaml", {"meso.constant_time.dawdling=0", "meso.step=" + step});
    const Model model = build_model(scenario, 0);
    Simulation simulation(model);
    std::map<int, double> last_mps;  // [vehicle]
    double hardest_mps2 = 0.0;
    lowest_mps = 1e9, highest_mps = 0.0;
    while (simulation.time_s() < scenario.duration_s) {
        simulation.step();
        const State& state = simulation.state();
        for (const LaneBlock& block : state.blocks) {
            for (int slot = block.first; slot < block.past_last(); ++slot) {
                const double speed_mps = state.vehicles.speed_mps[at(slot)];
                const auto [last, is_new] = last_mps.try_emplace(state.vehicles.id[at(slot)], speed_mps);
                if (!is_new) hardest_mps2 = std::max(hardest_mps2, (last->second - speed_mps) / model.step_s);
                last->second = speed_mps;
                lowest_mps = std::min(lowest_mps, speed_mps);
                highest_mps = std::max(highest_mps, speed_mps);
            }
        }
    }
    return hardest_mps2;
}

// A vehicle enters at the limit of 27.78 m/s and reaches a road with a limit of 13.89 m/s. A vehicle without leader
// drives at 95 % of the limit, so this vehicle must brake to 95 % of the lower limit.
TEST(SpeedLimits, VehicleWithoutLeaderBrakesComfortably) {
    double lowest_mps = 0.0, highest_mps = 0.0;
    EXPECT_LT(hardest_braking_mps2("speed_drop", lowest_mps, highest_mps), 2.5);
    EXPECT_GT(highest_mps, 27.7) << "the vehicle did not enter at the limit";
    EXPECT_LT(lowest_mps, 13.3) << "the vehicle did not reach 95 % of the lower limit";
}

// Fifteen edges of 20 m lead to a road with a limit of 2.78 m/s. The braking distance is longer than one edge, so
// vehicles must look several edges ahead.
TEST(SpeedLimits, AreForeseenOverShortEdges) {
    double lowest_mps = 0.0, highest_mps = 0.0;
    EXPECT_LT(hardest_braking_mps2("short_edges", lowest_mps, highest_mps), 3.0);
    EXPECT_GT(highest_mps, 25.0);
    EXPECT_LT(lowest_mps, 2.8);
}

// With steps of 0.5 s, a vehicle can drive over an edge of 20 m and the junctions of 0.1 m around it in two steps.
TEST(SpeedLimits, AreForeseenOverShortEdgesWithLongSteps) {
    double lowest_mps = 0.0, highest_mps = 0.0;
    EXPECT_LT(hardest_braking_mps2("short_edges", lowest_mps, highest_mps, "0.5 s"), 3.0);
    EXPECT_GT(highest_mps, 25.0);
    EXPECT_LT(lowest_mps, 2.8);
}

// The leader drives at 95 % of the limit, and its follower may drive at the limit. So the follower closes up by
// kExcess_m in the time kExcess_m / (5 % of the limit).
TEST(SpeedLimits, FollowersCloseUpToLeadersAtTheirSpeed) {
    constexpr double kExcess_m = 14.0;
    for (const std::string parameters : {"table2", "fitted", "passages"}) {
        for (const std::string policy : {"CDG", "CTG-Ref", "SWITCH-1"}) {
            TrackPlan plan;
            plan.policy = policy;
            plan.limit_mps = 40.0 / 3.6;
            plan.overrides = {"fidelity=meso", "meso=" + parameters, "meso.constant_time.dawdling=0",
                              "meso.constant_distance.dawdling=0"};
            plan.step_s = 0.1;
            Track track(plan);
            const Model& model = track.model();
            const double cruise_mps = model.leader_speed_share * model.speed_factor * plan.limit_mps;
            const GapPolicy& gap = model.policies[0];
            const double extra_m = equilibrium_gap_m(gap, cruise_mps) - gap.meso.gap_m(cruise_mps);
            const double equilibrium_m = model.following[0].equilibrium_gap_m(cruise_mps) + extra_m;
            track.place(0, 300.0, cruise_mps);
            track.place(0, 300.0 - model.vehicles[0].length_m - equilibrium_m - kExcess_m, cruise_mps);
            track.run(kExcess_m / ((1.0 - model.leader_speed_share) * model.speed_factor * plan.limit_mps) + 20.0);
            EXPECT_NEAR(track.vehicle(0, 1).gap_m, equilibrium_m, 0.7) << parameters << " " << policy;
        }
    }
}

// The parameters are fitted for speeds up to 50 km/h. On faster roads vehicles accelerate with the share of the power
// that the driver uses, which is one half.
TEST(SpeedLimits, FastRoadsAreReachedWithTheShareOfThePower) {
    for (const std::string parameters : {"fitted", "passages"}) {
        TrackPlan plan;
        plan.limit_mps = 100.0 / 3.6;
        plan.length_m = 4000.0;
        plan.overrides = {"fidelity=meso", "meso=" + parameters};
        plan.step_s = 0.1;
        Track track(plan);
        track.place(0, 10.0, 0.0);
        track.run(1.0);
        double speed_mps = track.vehicle(0, 0).speed_mps;
        while (track.time_s() < 60.0 && speed_mps < 0.9 * plan.limit_mps) {
            track.step();
            const double next_mps = track.vehicle(0, 0).speed_mps;
            if (speed_mps > 15.0 && speed_mps < 0.85 * plan.limit_mps) {
                const double power_mps2 = 0.5 * available_acceleration_mps2(track.model().vehicles[0], speed_mps);
                EXPECT_GT((next_mps - speed_mps) / 0.1, 0.85 * power_mps2) << parameters << " at " << speed_mps;
            }
            speed_mps = next_mps;
        }
        EXPECT_GE(speed_mps, 0.9 * plan.limit_mps) << parameters;
    }
}

}  // namespace
}  // namespace stopline
