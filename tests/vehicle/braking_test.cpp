// Tests of the brakes: lag, friction limit, stopping distance, standstill.
#include <gtest/gtest.h>

#include "support/cars.h"

namespace stopline {
namespace {

using namespace testing_support;

constexpr double kStep_s = 0.01;

class Braking : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(EveryVehicle, Braking, testing::ValuesIn(car_names()), as_test_name);

TEST_P(Braking, StopsWithinTheExpectedDistance) {
    const Car car(GetParam());
    for (const double v : {5.0, 50.0 / 3.6, 25.0}) {
        for (const double braking : {2.0, 4.0, 6.0}) {
            CarState s = cruising(car, v);
            double distance_m = 0.0;
            while (s.speed_mps > 0.0 && distance_m < 500.0) {
                const double previous_mps = s.speed_mps;
                s = advance(car, s, -braking, 0.0, kStep_s);
                distance_m += 0.5 * (previous_mps + s.speed_mps) * kStep_s;
            }
            // The lag of the brake adds at most the distance driven in its time constant. It adds less if resistances,
            // which act at once, provide part of the deceleration. The drag of the engine has the lag of the torque.
            const double lag_s = std::max(car.settings.brake_lag_s, longest_lag_s(car));
            const double distance_without_lag_m = v * v / (2.0 * braking);
            EXPECT_GT(distance_m, 0.99 * distance_without_lag_m) << v << ' ' << braking;
            EXPECT_LT(distance_m, 1.01 * distance_without_lag_m + v * lag_s) << v << ' ' << braking;
        }
    }
}

TEST_P(Braking, ForceFollowsAsAFirstOrderLag) {
    const Car car(GetParam());
    CarState s = cruising(car, 20.0);
    std::vector<double> force_N;
    for (int k = 0; k < 300; ++k) {
        s = advance(car, s, -5.0, 0.0, kStep_s);
        s.speed_mps = 20.0;
        s.gear = car.tables.gears - 1;
        force_N.push_back(s.brake_N);
        EXPECT_EQ(s.lag_s, car.settings.brake_lag_s);
    }
    const auto at_lag = static_cast<std::size_t>(std::lround(car.settings.brake_lag_s / kStep_s)) - 1;
    EXPECT_NEAR(force_N[at_lag] / force_N.back(), 1.0 - std::exp(-1.0), 0.01);
    EXPECT_NEAR(force_N[2 * at_lag + 1] / force_N.back(), 1.0 - std::exp(-2.0), 0.01);
}

TEST_P(Braking, NeverExceedsFriction) {
    for (const double friction : {0.8, 0.3}) {
        PowertrainSettings settings = load_vehicle(GetParam());
        settings.brake_friction = friction;
        const Car car(settings);
        CarState s = cruising(car, 30.0);
        double max_friction_use = 0.0;
        // The stop includes the moment at which the clutch opens. A brake force for the closed clutch is then too
        // large.
        while (s.speed_mps > 1.0) {
            s = advance(car, s, -15.0, 0.0, kStep_s);
            const double tyres_N = -s.acceleration_mps2 * car.mass_kg() - car.resistance_N(s.speed_mps);
            max_friction_use = std::max(max_friction_use, tyres_N / car.friction_N());
        }
        EXPECT_LT(max_friction_use, 1.02)
            << friction;  // 1 plus a margin for motor torque, which responds faster than brakes
        EXPECT_GT(max_friction_use, 0.9) << friction;
    }
}

TEST_P(Braking, SpeedIsNeverNegativeAndStandstillIsExact) {
    const Car car(GetParam());
    for (const double gradient : {-0.12, 0.0, 0.12}) {
        CarState s = cruising(car, 8.0);
        for (int k = 0; k < 1000; ++k) {
            s = advance(car, s, -3.0, car.grade_N(gradient), kStep_s);
            ASSERT_GE(s.speed_mps, 0.0);
            if (k > 500) {
                ASSERT_EQ(s.speed_mps, 0.0) << "gradient " << gradient;
                ASSERT_EQ(s.acceleration_mps2, 0.0) << "gradient " << gradient;
            }
        }
    }
}

TEST_P(Braking, HoldsStandstillUphillAndDownhill) {
    const Car car(GetParam());
    for (const double gradient : {-0.12, -0.06, 0.06, 0.12}) {
        CarState s = cruising(car, 0.0);
        s.brake_N = car.grade_N(0.12);  // brake force after the stop
        for (int k = 0; k < 6000; ++k) {
            s = advance(car, s, -0.3, car.grade_N(gradient), kStep_s);
            ASSERT_EQ(s.speed_mps, 0.0) << "gradient " << gradient << " after " << k * kStep_s << " s";
        }
    }
}

TEST_P(Braking, NeverRollsBackOnAHillStart) {
    const Car car(GetParam());
    for (const double gradient : {0.0, 0.06, 0.12}) {
        CarState s = cruising(car, 0.0);
        s.brake_N = car.grade_N(gradient) + 500.0;
        double start_s = -1.0;
        for (int k = 0; k < 500; ++k) {
            s = advance(car, s, 1.0, car.grade_N(gradient), kStep_s);
            ASSERT_GE(s.speed_mps, 0.0);
            if (start_s < 0.0 && s.speed_mps > 0.1) start_s = k * kStep_s;
        }
        EXPECT_GT(s.speed_mps, 1.5) << "gradient " << gradient;
        EXPECT_GT(start_s, 0.0);
        EXPECT_LT(start_s, 1.5) << "gradient " << gradient;
    }
}

}  // namespace
}  // namespace stopline
