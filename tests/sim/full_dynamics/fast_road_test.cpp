// Vehicles without leader on roads whose speed limit is beyond the range of the driver's acceleration profile.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "support/track.h"

namespace stopline {
namespace {

using namespace testing_support;

class FastRoad : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(EveryVehicle, FastRoad, testing::ValuesIn(data_names("vehicles")), as_name);

// Returns the time that a start from rest to `to_mps` takes, s. At each speed the vehicle accelerates as in the
// driver's profile, or with power_share times its available acceleration if this is more. Near the speed limit it
// accelerates less. It never accelerates more than its powertrain allows.
double start_time_s(const Model& model, const DriverSettings& driver, double to_mps, double limit_mps) {
    constexpr double kStep_s = 0.01;
    const SampledCurve profile{driver.free_drive.speed_mps, driver.free_drive.acceleration_mps2};
    double speed_mps = 0.0;
    double time_s = 0.0;
    for (; speed_mps < to_mps; time_s += kStep_s) {
        const double available_mps2 = available_acceleration_mps2(model.vehicles[0], speed_mps);
        const double power_mps2 = driver.free_drive.power_share * available_mps2;
        const double towards_limit_mps2 = driver.free_drive.speed_gain_1ps * (limit_mps - speed_mps);
        const double wanted_mps2 = std::min(std::max(interpolate(profile, speed_mps), power_mps2), towards_limit_mps2);
        speed_mps += std::min(wanted_mps2, available_mps2) * kStep_s;
    }
    return time_s;
}

TEST_P(FastRoad, TheStartContinuesWithTheShareOfThePower) {
    for (const double limit_kmh : {70.0, 100.0}) {
        TrackPlan plan;
        plan.vehicle = GetParam();
        plan.limit_mps = limit_kmh / 3.6;
        plan.length_m = 4000.0;
        Track track(plan);
        track.place(0, 10.0, 0.0);
        const PowertrainTables& car = track.model().vehicles[0];
        const double limit_mps = std::min(plan.limit_mps, car.maximum_speed_mps);
        const double to_mps = 0.95 * limit_mps;
        while (track.vehicle(0, 0).speed_mps < to_mps && track.time_s() < 120.0) track.step();
        const double expected_s = start_time_s(track.model(), load_driver("startup_kit"), to_mps, limit_mps);
        // Gear changes interrupt the torque, and the torque lags.
        EXPECT_GT(track.time_s(), expected_s - 0.5) << limit_kmh << " km/h";
        EXPECT_LT(track.time_s(), expected_s + 6.0 + 3.0 * car.gears * car.torque_interruption_s)
            << limit_kmh << " km/h";
    }
}

// If the speed limit is within the speed range of the profile, only the profile counts, and power_share has no effect.
TEST_P(FastRoad, TheProfileAloneCountsUpToItsLimit) {
    const auto speed_after_10_s = [&](const std::string& power_share) {
        TrackPlan plan;
        plan.vehicle = GetParam();
        plan.overrides = {"driver={base: startup_kit, free_drive: {power_share: " + power_share + "}}"};
        Track track(plan);
        track.place(0, 10.0, 0.0);
        track.run(10.0);
        return track.vehicle(0, 0).speed_mps;
    };
    EXPECT_EQ(speed_after_10_s("100 %"), speed_after_10_s("1 %"));
}

TEST(AvailableAcceleration, IsThePowerLimitAtHighSpeed) {
    const Model model = build_model(single_light("petrol_eu4_72kw", "CDG"), 0);
    const PowertrainTables& car = model.vehicles[0];
    double last_mps2 = 1e9;
    for (const double v : {20.0, 25.0, 30.0, 35.0, 40.0}) {
        const double resistance_N = car.rolling_N + car.rolling_Nspm * v + car.drag_Ns2pm2 * v * v;
        const double by_power_mps2 = (72e3 * car.efficiency / v - resistance_N) * car.inverse_mass_1pkg;
        const double available_mps2 = available_acceleration_mps2(car, v);
        EXPECT_LT(available_mps2, by_power_mps2) << v;
        EXPECT_GT(available_mps2, 0.6 * by_power_mps2 - 0.1) << v;
        EXPECT_LT(available_mps2, last_mps2) << v;
        last_mps2 = available_mps2;
    }
}

}  // namespace
}  // namespace stopline
