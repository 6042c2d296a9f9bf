// A vehicle too weak for its mass requests more acceleration than its engine gives. Its followers must not rely on the
// request.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "support/track.h"

namespace stopline {
namespace {

using namespace testing_support;

// A queue of lorries would be too long for the approach of the base scenario, so the demand is a single vehicle. The
// tests place their own vehicles.
const std::vector<std::string> kLorry = {
    "vehicle={base: petrol_eu4_72kw, name: lorry, length: 16 m, mass: 30000 kg, load: 5000 kg}", "demand.vehicles=1"};

TEST(WeakVehicles, AnnounceOnlyWhatTheEngineGives) {
    TrackPlan plan;
    plan.overrides = kLorry;
    Track track(plan);
    track.place(0, 100.0, 8.0);
    track.run(5.0);
    const VehicleView lorry = track.vehicle(0, 0);
    const float announced = track.state().vehicles.v2v_request_mps2[track.state().v2v.now + track.slot(0, 0)];
    ASSERT_GT(lorry.request_mps2, 2.0 * lorry.acceleration_mps2) << "the lorry is strong enough for its request";
    EXPECT_NEAR(announced, lorry.acceleration_mps2, 0.05);
}

// Each lorry starts 20 m behind its leader and closes up. All lorries request as much acceleration as they may.
TEST(WeakVehicles, KeepTheirGapsInAPlatoon) {
    constexpr int kLorries = 8;
    for (const std::string policy : {"CDG", "CTG-Ref", "SWITCH-1", "SWITCH-2"}) {
        TrackPlan plan;
        plan.policy = policy;
        plan.length_m = 3000.0;
        plan.overrides = kLorry;
        Track track(plan);
        for (int k = 0; k < kLorries; ++k) track.place(0, 500.0 - 36.0 * k, 10.0);
        double largest_shortfall_mps2 = 0.0;
        double smallest_gap_m = 1e9;
        while (track.time_s() < 150.0) {
            track.step();  // checks that no two lorries overlap
            if (HasFatalFailure()) return;
            for (int k = 1; k < kLorries; ++k) {
                const VehicleView lorry = track.vehicle(0, k);
                largest_shortfall_mps2 = std::max(largest_shortfall_mps2, lorry.request_mps2 - lorry.acceleration_mps2);
                smallest_gap_m = std::min(smallest_gap_m, lorry.gap_m);
            }
        }
        EXPECT_GT(largest_shortfall_mps2, 1.0) << policy << ": no lorry was too weak for its request";
        EXPECT_GT(smallest_gap_m, 2.0) << policy;
    }
}

}  // namespace
}  // namespace stopline
