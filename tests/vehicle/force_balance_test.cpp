// Tests of the force balance in closed form: coasting, full load in every gear, energy.
#include <gtest/gtest.h>

#include "support/cars.h"

namespace stopline {
namespace {

using namespace testing_support;

class ForceBalance : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(EveryVehicle, ForceBalance, testing::ValuesIn(car_names()), as_test_name);

// Returns the vehicle with a single gear and an engine without torque and drag. This vehicle coasts even if it is asked
// to accelerate, so the low-level controller cannot hide a wrong resistance.
Car without_engine(const std::string& name, std::size_t gear) {
    PowertrainSettings s = load_vehicle(name);
    for (double& torque : s.full_load.y) torque = 0.0;
    s.drag_torque = {};
    s.gear_ratio = {s.gear_ratio[gear]};
    s.rotating_mass_factor = {s.rotating_mass_factor[gear]};
    s.lag_gear_factor = {1.0};
    return Car(std::move(s));
}

// Returns the speed at time t from m lambda dv/dt = -(A + B v + C v^2) with 4 A C > B^2: mass m, rotating mass factor
// lambda, driving resistances A, B and C.
double coasting_speed(const Car& car, double grade_N, double v0, double t) {
    const double A = car.rolling_N() + grade_N;
    const double B = car.rolling_Nspm();
    const double C = car.air_Ns2pm2();
    const double root = std::sqrt(4.0 * A * C - B * B);
    const double inertia_kg = car.mass_kg() * car.rotating(0);
    const double angle = std::atan((2.0 * C * v0 + B) / root) - 0.5 * root * t / inertia_kg;
    return (root * std::tan(angle) - B) / (2.0 * C);
}

TEST_P(ForceBalance, CoastingFollowsTheAnalyticSolution) {
    const double v0 = 100.0 * kMpsPerKmh;
    for (const std::size_t gear : {std::size_t{0}, load_vehicle(GetParam()).gear_ratio.size() - 1}) {
        const Car car = without_engine(GetParam(), gear);
        for (const double gradient : {0.0, 0.03, 0.1}) {
            const double grade_N = car.grade_N(gradient);
            CarState s = cruising(car, v0);
            int k = 0;
            while (s.speed_mps > 5.0) {
                s = advance(car, s, 1.0, grade_N, 0.01);
                ++k;
                ASSERT_NEAR(s.speed_mps, coasting_speed(car, grade_N, v0, 0.01 * k), 0.005)
                    << "after " << k << " steps";
            }
            EXPECT_GT(k, 1000 / (1 + static_cast<int>(200 * gradient)));
        }
    }
}

// The test holds each gear at full load. Torque curve, gear ratio, losses and rotating mass give the acceleration.
TEST_P(ForceBalance, FullLoadAccelerationFollowsTheTorqueCurve) {
    const Car car(GetParam());
    for (int gear = 0; gear < car.tables.gears; ++gear) {
        for (double v = 1.0; car.rpm(v, gear) < 0.98 * car.settings.limiter_rpm; v += 1.0) {
            if (car.rpm(v, gear) < (gear == 0 ? car.settings.launch_rpm : car.settings.idle_rpm)) continue;
            CarState s = cruising(car, v);
            for (int k = 0; k < 300; ++k) {
                s.gear = gear;
                s.gear_time_s = 1.0;
                s.speed_mps = v;
                s = advance(car, s, 20.0, 0.0, 0.01);
            }
            const double force_N = std::min(car.full_force_N(v, gear), car.friction_N()) - car.resistance_N(v);
            const double expected = force_N / (car.mass_kg() * car.rotating(gear));
            // The tolerance covers corners of the curve that lie between grid nodes.
            EXPECT_NEAR(s.acceleration_mps2, expected, 0.015 * std::fabs(expected) + 0.01)
                << "gear " << gear + 1 << ", speed " << v;
        }
    }
}

// With one gear and no clutch, the motor's work becomes kinetic energy and losses in driveline, resistances and brake.
// This holds for any sequence of requests.
TEST(ElectricCar, ConservesEnergy) {
    const Car car("electric_100kw");
    const double efficiency = car.settings.driveline_efficiency;
    const double inertia_kg = car.mass_kg() * car.rotating(0);
    const double grade_N = car.grade_N(0.02);
    for (const double dt : {0.01, 0.005}) {
        CarState s = cruising(car, 10.0);
        double wheel_J = 0.0;
        double lost_J = 0.0;
        double absolute_J = 0.0;  // absolute work of the motor, the scale of the tolerance
        const double begin_J = 0.5 * inertia_kg * s.speed_mps * s.speed_mps;
        for (int k = 0; k * dt < 120.0; ++k) {
            const double t = k * dt;
            const double request = 1.5 * std::sin(0.31 * t) + std::sin(1.7 * t);
            const CarState next = advance(car, s, request, grade_N, dt);
            const double mean_mps = 0.5 * (s.speed_mps + next.speed_mps);
            const double motor_W = next.torque_Nm * car.rpm(mean_mps, 0) * kRadpsPerRpm;
            wheel_J += (motor_W > 0.0 ? motor_W * efficiency : motor_W / efficiency) * dt;
            lost_J += (car.resistance_N(mean_mps) + grade_N + next.brake_N) * mean_mps * dt;
            absolute_J += std::fabs(motor_W) * dt;
            s = next;
        }
        const double gained_J = 0.5 * inertia_kg * s.speed_mps * s.speed_mps - begin_J;
        EXPECT_NEAR(wheel_J, gained_J + lost_J, 1e-3 * absolute_J) << dt;
    }
}

// On a start from rest to 100 km/h, the engine's work at the wheels is one to two times the kinetic energy.
TEST_P(ForceBalance, StartNeedsAtLeastTheKineticEnergy) {
    const Car car(GetParam());
    CarState s = cruising(car, 0.0);
    double crank_J = 0.0;
    int steps = 0;
    while (s.speed_mps < 100.0 * kMpsPerKmh && ++steps < 10'000) {
        s = advance(car, s, 2.0, 0.0, 0.01);
        const int gear = static_cast<int>(s.gear);
        const double rpm = std::max(gear == 0 ? car.settings.launch_rpm : 0.0, car.rpm(s.speed_mps, gear));
        crank_J += std::max(0.0, s.torque_Nm) * rpm * kRadpsPerRpm * 0.01;
    }
    ASSERT_LT(steps, 10'000);
    const double kinetic_J = 0.5 * car.mass_kg() * s.speed_mps * s.speed_mps;
    EXPECT_GT(car.settings.driveline_efficiency * crank_J, kinetic_J);
    EXPECT_LT(car.settings.driveline_efficiency * crank_J, 2.0 * kinetic_J);
}

}  // namespace
}  // namespace stopline
