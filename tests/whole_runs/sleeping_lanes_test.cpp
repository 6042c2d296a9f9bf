// In the mesoscale mode, a lane sleeps while its first vehicle rests at a red signal. The scalar kernels let no lane
// sleep. Both must give the same bits. In these runs, the leader of the first vehicle leaves while the lane sleeps.
#include <gtest/gtest.h>

#include <string>

#include "scenario/build_model.h"
#include "scenario/load_scenario.h"
#include "sim/step/simulation.h"

namespace stopline {
namespace {

void expect_same_bits(const std::string& text, double until_s) {
    const Model model = build_model(parse_scenario(text, "test.yaml"), 0);
    Model scalar_model = model;
    scalar_model.scalar_kernels = true;
    Simulation simulation(model);
    Simulation scalar(scalar_model);
    simulation.run_until(until_s);
    scalar.run_until(until_s);
    EXPECT_GT(simulation.state().records.entered, 20);
    EXPECT_EQ(simulation.state_hash(), scalar.state_hash());
}

// The platoon of a queue at red can begin beyond the stop line.
TEST(SleepingLanes, DecideAboutPlatoonsByThePresentLeader) {
    expect_same_bits(R"(
fidelity: meso
network: {kind: intersection}
signal:
  phases:
  - protected: [west_straight, west_right, east_straight, east_right]
    permissive: [west_left, east_left]
    green: 0.1 s
  - protected: [south_straight, south_right, north_straight, north_right]
    permissive: [south_left, north_left]
    green: 0.5 s
driver: {base: startup_kit, platoon: {max_vehicles: 2}}
populations: [CDG]
)",
                     175.0);
}

// A human driver at rest measures the time since the vehicle ahead began to move.
TEST(SleepingLanes, HumanDriversObserveThePresentLeader) {
    expect_same_bits(R"(
seed: 724172
fidelity: meso
meso: start_passages
network:
  kind: intersection
  intersection:
    lanes: [{movements: left}, {movements: straight}, {movements: straight}, {movements: straight+right}]
    radius: 28 m
    approach_length: 248 m
    lane_width: 4.3 m
    turn_speed: 10 m/s
    clearance: 2.9 m
signal:
  first_green: 1 s
  phases:
  - protected: [west_straight, west_right, east_straight, east_right]
    permissive: [west_left, east_left]
    green: 21 s
    yellow: 2 s
    all_red: 2 s
  - protected: [south_straight, south_right, north_straight, north_right]
    permissive: [south_left, north_left]
    green: 25 s
    yellow: 4 s
    all_red: 3 s
demand: {kind: saturated, cross_inflow: 326 veh/h}
vehicle: {base: diesel_eu4_103kw, length: 0.5 m, load: 343 kg}
driver:
  base: startup_kit
  cacc: {radar_delay: 0 ms, v2v_delay: 100 ms}
  give_way: {approach_acceleration: 1.5 m/s2}
  lane_change: {gap_opening: off, look_ahead: off, politeness: 0.5}
  human: {reaction: 1.22 s, gap_error: 0.29}
rules: {sight: 228 m}
populations:
- {name: X, pattern: balanced, components: [{policy: CTG-HBS, share: 50 %}, {policy: HUMAN, share: 50 %}]}
)",
                     90.0);
}

}  // namespace
}  // namespace stopline
