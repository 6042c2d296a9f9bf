// Tests that the torque follows its request as a first-order lag. The time constant comes from the lag map of the
// vehicle.
#include <gtest/gtest.h>

#include "support/cars.h"

namespace stopline {
namespace {

using namespace testing_support;

class TorqueLag : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(EveryVehicle, TorqueLag, testing::ValuesIn(car_names()), as_test_name);

// Returns the time constant from the lag map, s. The shipped maps do not depend on the torque, so the first column
// suffices.
double map_lag_s(const Car& car, double rpm) {
    SampledCurve over_rpm{car.settings.lag_rpm, {}};
    const std::size_t columns = car.settings.lag_torque_share.size();
    for (std::size_t row = 0; row < car.settings.lag_rpm.size(); ++row) {
        over_rpm.y.push_back(car.settings.lag_drive_s[row * columns]);
    }
    return interpolate(over_rpm, rpm);
}

TEST_P(TorqueLag, MatchesTheMapInEveryGear) {
    const Car car(GetParam());
    for (int gear = 0; gear < car.tables.gears; ++gear) {
        for (double share = 0.3; share < 0.95; share += 0.2) {
            const double rpm = share * car.settings.limiter_rpm;
            if (gear == 0 && rpm < car.settings.launch_rpm) continue;  // the slipping clutch holds the launch speed
            const double v = rpm / car.rpm(1.0, gear);
            CarState s = cruising(car, v);
            // Holds gear and speed and requests a share of full load.
            const auto advance_at = [&](double load, double dt) {
                s.gear = gear;
                s.gear_time_s = 1.0;
                s.speed_mps = v;
                const double force_N = load * car.full_force_N(v, gear) - car.resistance_N(v);
                s = advance(car, s, force_N / (car.mass_kg() * car.rotating(gear)), 0.0, dt);
            };
            for (int k = 0; k < 500; ++k) advance_at(0.3, 0.01);
            const double initial_Nm = s.torque_Nm;
            const double tau_s = s.lag_s;
            EXPECT_NEAR(tau_s, map_lag_s(car, rpm), 0.05 * tau_s) << "gear " << gear + 1 << ", " << rpm << " rpm";
            // Advance by one time constant after a jump of the request, in a hundred steps.
            for (int k = 0; k < 100; ++k) advance_at(0.6, 0.01 * tau_s);
            const double after_tau_Nm = s.torque_Nm;
            for (int k = 0; k < 500; ++k) advance_at(0.6, 0.01);
            EXPECT_NEAR((after_tau_Nm - initial_Nm) / (s.torque_Nm - initial_Nm), 1.0 - std::exp(-1.0), 0.01);
        }
    }
}

// The map depends on engine speed, share of full load and gear.
TEST(TorqueLagMap, IsInterpolatedAndScaledByGear) {
    PowertrainSettings s = load_vehicle("petrol_eu4_72kw");
    s.lag_rpm = {0.0, 6500.0};
    s.lag_torque_share = {0.0, 1.0};
    s.lag_drive_s = {0.1, 0.3, 0.2, 0.8};
    s.lag_gear_factor = {1.0, 1.1, 1.2, 1.3, 1.4};
    const PowertrainTables tables = compile_powertrain(s);
    for (double gear = 0.0; gear < 5.0; gear += 1.0) {
        for (double x = 0.0; x <= 1.0; x += 0.05) {
            for (double y = 0.0; y <= 1.0; y += 0.05) {
                const double bilinear = (1 - x) * ((1 - y) * 0.1 + y * 0.3) + x * ((1 - y) * 0.2 + y * 0.8);
                EXPECT_NEAR(torque_lag_s(tables, gear, 6500.0 * x, y), bilinear * (1.0 + 0.1 * gear), 1e-12);
            }
        }
    }
}

}  // namespace
}  // namespace stopline
