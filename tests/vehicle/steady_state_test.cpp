// Tests of the powertrain in steady state. At constant speed, the realised acceleration is within 2 % of the request on
// every gradient where torque or brake suffices.
#include <gtest/gtest.h>

#include "support/cars.h"

namespace stopline {
namespace {

using namespace testing_support;

constexpr double kStep_s = 0.01;

class SteadyState : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(EveryVehicle, SteadyState, testing::ValuesIn(car_names()), as_test_name);

// Returns the state after holding request and speed until one gear has been engaged for more than a second.
CarState settled(const Car& car, double v_mps, double request_mps2, double grade_N) {
    CarState s = cruising(car, v_mps);
    for (int k = 0; k < 3000; ++k) {
        s = advance(car, s, request_mps2, grade_N, kStep_s);
        s.speed_mps = v_mps;
        if (k > 600 && s.gear_time_s > 1.2) break;
    }
    return s;
}

// Returns true if engine and brake can deliver the force in this gear. A slipping clutch transmits only part of the
// engine's inertia, so the force must be feasible with and without rotating masses.
bool feasible(const Car& car, double v_mps, int gear, double request_mps2, double grade_N) {
    if (car.rpm(v_mps, gear) > car.settings.limiter_rpm) return false;
    const double resistance_N = car.resistance_N(v_mps) + grade_N;
    for (const double rotating : {1.0, car.rotating(gear)}) {
        const double force_N = car.mass_kg() * rotating * request_mps2 + resistance_N;
        if (force_N > 0.995 * car.full_force_N(v_mps, gear) || std::fabs(force_N) > 0.999 * car.friction_N())
            return false;
    }
    return true;
}

TEST_P(SteadyState, MeetsTheRequestWithinTwoPercent) {
    const Car car(GetParam());
    int feasible_cases = 0;
    for (const double gradient : {-0.08, -0.05, -0.02, 0.0, 0.02, 0.05, 0.08, 0.12}) {
        const double grade_N = car.grade_N(gradient);
        for (const double v : {1.0, 2.5, 4.0, 6.0, 9.0, 12.0, 13.9, 18.0, 25.0, 33.0}) {
            for (double request = -3.0; request <= 2.01; request += 0.25) {
                const CarState s = settled(car, v, request, grade_N);
                if (!feasible(car, v, static_cast<int>(s.gear), request, grade_N)) continue;
                const double allowed = std::max(0.02 * std::fabs(request), 0.005);
                ASSERT_NEAR(s.acceleration_mps2, request, allowed)
                    << "speed " << v << ", gradient " << gradient << ", gear " << s.gear + 1;
                ++feasible_cases;
            }
        }
    }
    EXPECT_GT(feasible_cases, 1000) << "cases where torque suffices";
}

// In steady state the brake never works against the engine.
TEST_P(SteadyState, NeverBrakesAgainstTheEngine) {
    const Car car(GetParam());
    for (const double gradient : {-0.08, 0.0, 0.08}) {
        for (const double v : {2.0, 8.0, 14.0, 25.0}) {
            for (double request = -3.0; request <= 2.01; request += 0.5) {
                const CarState s = settled(car, v, request, car.grade_N(gradient));
                EXPECT_TRUE(s.torque_Nm < 0.5 || s.brake_N < 1.0)
                    << "speed " << v << ", gradient " << gradient << ", request " << request << ": " << s.torque_Nm
                    << " N m against " << s.brake_N << " N";
            }
        }
    }
}

// A request beyond the vehicle's power gives full load.
TEST_P(SteadyState, GivesFullLoadForExcessiveRequests) {
    const Car car(GetParam());
    for (const double v : {4.0, 9.0, 14.0, 25.0}) {  // at lower speeds the clutch may slip
        const CarState s = settled(car, v, 9.0, 0.0);
        const int gear = static_cast<int>(s.gear);
        const double force_N = std::min(car.full_force_N(v, gear), car.friction_N());
        const double expected = (force_N - car.resistance_N(v)) / (car.mass_kg() * car.rotating(gear));
        EXPECT_NEAR(s.acceleration_mps2, expected, 0.02 * expected + 0.005) << "speed " << v << ", gear " << gear + 1;
    }
}

}  // namespace
}  // namespace stopline
