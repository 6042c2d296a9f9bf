// Mesoscale mode: each driver brakes before a turn with its own deceleration.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "base/containers/index.h"
#include "scenario/build_model.h"
#include "scenario/load_scenario.h"
#include "sim/step/simulation.h"

namespace stopline {
namespace {

// Before a turn, no vehicle is faster than its braking curve v^2 = v_end^2 + 2 b distance allows. Vehicles with the
// larger deceleration b are faster than the curve of the others.
TEST(SlowDown, EachDriverHasItsOwnDeceleration) {
    constexpr double kTolerance_mps = 0.3;  // a vehicle returns to its curve with a delay (turn_gain)
    const Scenario scenario = load_scenario(
        STOPLINE_SOURCE_DIR "/scenarios/intersection.yaml",
        {"fidelity=meso", "meso=fitted", "demand={kind: rate, inflow: 800 veh/h, right: 100 %}", "signal.green=60 s",
         "measure.baseline=mixed",
         "populations=[{name: mixed, components: [{policy: CTG-Ref, share: 50 %, driver: {base: startup_kit, free_drive: "
         "{deceleration: 1 m/s2}}}, {policy: CTG-Ref, share: 50 %, driver: {base: startup_kit, free_drive: "
         "{deceleration: 2 m/s2}}}]}]"});
    for (const bool scalar : {false, true}) {
        Model model = build_model(scenario, 0);
        model.scalar_kernels = scalar;
        ASSERT_EQ(model.slow_downs_mps2.size(), 2u);
        Simulation simulation(model);
        const VehicleArrays& v = simulation.state().vehicles;
        int beyond_slower_curve = 0;
        while (simulation.time_s() < 200.0) {
            simulation.step();
            for (const LaneBlock& block : simulation.state().blocks) {
                for (int slot = block.first; slot < block.past_last(); ++slot) {
                    const std::size_t i = at(slot);
                    if (v.end_speed_mps[i] >= kNoLowerLimit_mps) continue;
                    const double end_mps = v.end_speed_mps[i];
                    const double distance_m = std::max(v.next_limit_m[i] - v.position_m[i], 0.0);
                    const auto curve_mps = [&](double b) {
                        return std::sqrt(end_mps * end_mps + 2.0 * b * distance_m);
                    };
                    ASSERT_LT(v.speed_mps[i], curve_mps(model.slow_downs_mps2[at(v.policy[i])]) + kTolerance_mps);
                    if (v.speed_mps[i] > curve_mps(1.0) + kTolerance_mps) ++beyond_slower_curve;
                }
            }
        }
        EXPECT_GT(beyond_slower_curve, 100);
    }
}

}  // namespace
}  // namespace stopline
