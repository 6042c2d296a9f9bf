// Conformance of every policy with every vehicle: from every feasible state it stops before a red line and behind a standing
// vehicle, without overlap, and from afar on the spot that it shall stop at.
#include <gtest/gtest.h>

#include "base/speed_thresholds.h"
#include "support/track.h"

namespace stopline {
namespace {

using namespace testing_support;

// Feasible: braking with this after this delay (jerk of the command and lag of the brake) suffices.
constexpr double kFeasible_mps2 = 6.0;
constexpr double kDelay_s = 0.35;

struct Approach {
    double speed_mps;
    double distance_m;
    bool far;
};

std::vector<Approach> approaches() {
    std::vector<Approach> all;
    for (const double kmh : {5.0, 12.0, 22.0, 35.0, 50.0, 60.0}) {
        const double v = kmh / 3.6;
        const double least_m = v * v / (2.0 * kFeasible_mps2) + kDelay_s * v;
        for (const double times : {1.001, 1.15, 1.5, 2.5}) all.push_back({v, times * least_m, false});
        all.push_back({v, 170.0, true});
    }
    return all;
}

TrackPlan red_road(const Pairing& pairing, std::size_t lanes) {
    TrackPlan plan;
    plan.policy = pairing.policy;
    plan.vehicle = pairing.vehicle;
    plan.lanes = static_cast<int>(lanes);
    plan.length_m = 1000.0;
    plan.limit_mps = 60.0 / 3.6;
    plan.green_from_s = kForever_s;
    return plan;
}

std::string text(const Approach& a) {
    return "from " + std::to_string(3.6 * a.speed_mps) + " km/h, " + std::to_string(a.distance_m) + " m before";
}

class Stopping : public testing::TestWithParam<Pairing> {};
INSTANTIATE_TEST_SUITE_P(SlowEveryPairing, Stopping, testing::ValuesIn(every_pairing()), as_pairing_name);
INSTANTIATE_TEST_SUITE_P(OnePairing, Stopping, testing::Values(Pairing{"SWITCH-1", "petrol_eu4_72kw"}),
                         as_pairing_name);

TEST_P(Stopping, BeforeARedLine) {
    const std::vector<Approach> all = approaches();
    Track track(red_road(GetParam(), all.size()));
    for (std::size_t k = 0; k < all.size(); ++k) {
        track.place(static_cast<int>(2 * k), 1000.0 - all[k].distance_m, all[k].speed_mps);
    }
    track.run(45.0);
    EXPECT_EQ(track.state().records.passages.size(), 0u) << "vehicles past the line";
    EXPECT_EQ(track.state().records.violations.forced_red_entries, 0);
    const double margin_m = track.model().driver.stop.margin_m;
    for (std::size_t k = 0; k < all.size(); ++k) {
        ASSERT_EQ(track.count(static_cast<int>(2 * k)), 1) << text(all[k]);
        const Seen car = track.seen(static_cast<int>(2 * k), 0);
        EXPECT_LT(car.speed_mps, kBrakeHoldSpeed_mps) << text(all[k]);
        const double left_m = 1000.0 - car.position_m;
        EXPECT_GT(left_m, 0.0) << text(all[k]);
        if (all[k].far) {
            EXPECT_NEAR(left_m, margin_m, 0.1) << text(all[k]);
        }
    }
}

TEST_P(Stopping, BehindAStandingVehicle) {
    const std::vector<Approach> all = approaches();
    Track track(red_road(GetParam(), all.size()));
    const double margin_m = track.model().driver.stop.margin_m;
    const double length_m = track.model().vehicles[0].length_m;
    for (std::size_t k = 0; k < all.size(); ++k) {
        const int lane = static_cast<int>(2 * k);
        track.place(lane, 1000.0 - margin_m, 0.0);
        track.place(lane, 1000.0 - margin_m - length_m - all[k].distance_m, all[k].speed_mps);
    }
    std::vector<double> closest_m(all.size(), 1e9);
    for (int n = 0; n < 4500; ++n) {
        track.step();
        for (std::size_t k = 0; k < all.size(); ++k) {
            closest_m[k] = std::min(closest_m[k], track.seen(static_cast<int>(2 * k), 1).gap_m);
        }
    }
    const double wanted_m = equilibrium_gap_m(track.model().policies[0].settings, 0.0);
    for (std::size_t k = 0; k < all.size(); ++k) {
        const Seen car = track.seen(static_cast<int>(2 * k), 1);
        EXPECT_GT(closest_m[k], 0.0) << text(all[k]);
        EXPECT_LT(car.speed_mps, kBrakeHoldSpeed_mps) << text(all[k]);
        if (all[k].far) {
            EXPECT_NEAR(car.gap_m, wanted_m, 0.1) << text(all[k]);
        }
    }
}

}  // namespace
}  // namespace stopline
