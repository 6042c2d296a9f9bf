// Tests of gear changes: in order, at the scheduled engine speeds, with the set torque interruption, without hunting.
#include <gtest/gtest.h>

#include "support/cars.h"

namespace stopline {
namespace {

using namespace testing_support;

constexpr double kStep_s = 0.01;

class Gearbox : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(EveryVehicle, Gearbox, testing::ValuesIn(car_names()), as_test_name);

// At constant speed and load the gear settles within 20 s. At most one change may follow in the next 20 s.
TEST_P(Gearbox, NeverHunts) {
    constexpr double kCoarse_s = 0.02;
    const Car car(GetParam());
    int hunting_cases = 0;
    for (const double gradient : {-0.08, -0.03, 0.0, 0.03, 0.06, 0.12}) {
        for (double v = 0.5; v < 45.0; v += 0.75) {
            for (const double request : {-3.0, -1.0, -0.4, -0.1, 0.0, 0.1, 0.25, 0.5, 1.0, 1.5, 2.0}) {
                CarState s = cruising(car, v);
                int changes = 0;
                for (int k = 0; k < 2000; ++k) {
                    const double previous_gear = s.gear;
                    s = advance(car, s, request, car.grade_N(gradient), kCoarse_s);
                    s.speed_mps = v;
                    if (k >= 1000 && s.gear != previous_gear) ++changes;
                }
                if (changes <= 1) continue;
                ++hunting_cases;
                EXPECT_GT(hunting_cases, 10) << "speed " << v << ", request " << request << ", gradient " << gradient
                                             << ": " << changes << " changes in 20 s, now in gear " << s.gear + 1;
            }
        }
    }
    EXPECT_EQ(hunting_cases, 0) << "cases (the first ten are shown)";
}

struct Change {
    double time_s;
    int from, to;  // gears, counted from 0
    double rpm;    // engine speed before the change
};

struct Drive {
    std::vector<CarState> states;
    std::vector<Change> changes;
};

Drive drive(const Car& car, CarState s, double request_mps2, double until_mps, double duration_s) {
    Drive result;
    for (int k = 0; k * kStep_s < duration_s; ++k) {
        const CarState next = advance(car, s, request_mps2, 0.0, kStep_s);
        if (next.gear != s.gear) {
            const int gear = static_cast<int>(s.gear);
            result.changes.push_back({k * kStep_s, gear, static_cast<int>(next.gear), car.rpm(s.speed_mps, gear)});
        }
        s = next;
        result.states.push_back(s);
        if (request_mps2 > 0.0 ? s.speed_mps > until_mps : s.speed_mps <= until_mps) break;
    }
    return result;
}

TEST_P(Gearbox, ShiftsUpOneGearAtATimeWithinTheSchedule) {
    const Car car(GetParam());
    for (const double request : {0.6, 1.5, 9.0}) {
        const Drive start = drive(car, cruising(car, 0.0), request, 120.0 * kMpsPerKmh, 120.0);
        const int highest = static_cast<int>(start.states.back().gear);
        EXPECT_EQ(static_cast<int>(start.changes.size()), highest);
        for (const Change& change : start.changes) {
            EXPECT_EQ(change.to, change.from + 1) << "at " << change.time_s;
            EXPECT_GE(change.rpm, car.settings.shift_up_part_load_rpm - 1.0);
            EXPECT_LE(change.rpm, car.settings.shift_up_full_load_rpm * 1.03);
        }
        if (!car.electric()) {
            EXPECT_GE(highest, 3) << "request " << request;
        }
    }
}

TEST_P(Gearbox, ShiftsAtHigherEngineSpeedForHigherRequests) {
    const Car car(GetParam());
    if (car.electric()) GTEST_SKIP() << "one gear";
    const Drive gentle = drive(car, cruising(car, 0.0), 0.6, 20.0, 60.0);
    const Drive hard = drive(car, cruising(car, 0.0), 9.0, 20.0, 60.0);
    const double ratio = car.settings.shift_up_full_load_rpm / car.settings.shift_up_part_load_rpm;
    EXPECT_GT(hard.changes.front().rpm, std::min(1.5, 0.9 * ratio) * gentle.changes.front().rpm);
}

// A gear change interrupts the torque, and the vehicle coasts meanwhile. The total coasting time must equal the set
// interruption times the number of gear changes. After the interruption the torque builds up with its lag, so it
// exceeds the resistances a little later.
TEST_P(Gearbox, InterruptsTheTorqueForTheSetTime) {
    const Car car(GetParam());
    const Drive start = drive(car, cruising(car, 0.0), 1.5, 100.0 * kMpsPerKmh, 60.0);
    double coasting_s = 0.0;
    for (const CarState& s : start.states)
        coasting_s += s.acceleration_mps2 <= 0.0 && s.speed_mps > 0.0 ? kStep_s : 0.0;
    const auto changes = static_cast<double>(start.changes.size());
    const double build_up_s = car.settings.torque_interruption_s > 0.5 ? 0.1 * longest_lag_s(car) : 0.0;
    EXPECT_NEAR(coasting_s, changes * (car.settings.torque_interruption_s + 0.5 * build_up_s),
                (changes + 1.0) * (1.5 * kStep_s + 0.5 * build_up_s));
}

TEST_P(Gearbox, KeepsAGearForItsMinimumTime) {
    const Car car(GetParam());
    for (const double request : {0.6, 1.5, 9.0}) {
        const Drive start = drive(car, cruising(car, 0.0), request, 120.0 * kMpsPerKmh, 120.0);
        for (std::size_t k = 1; k < start.changes.size(); ++k) {
            EXPECT_GE(start.changes[k].time_s - start.changes[k - 1].time_s,
                      car.settings.minimum_gear_time_s - 1.5 * kStep_s);
        }
    }
}

TEST_P(Gearbox, StopsInFirstGearAndStartsAgain) {
    const Car car(GetParam());
    for (const double request : {-0.8, -2.0, -6.0}) {
        const Drive stop = drive(car, cruising(car, 30.0), request, 0.0, 60.0);
        ASSERT_EQ(stop.states.back().speed_mps, 0.0) << request;
        EXPECT_EQ(stop.states.back().gear, 0.0) << request;
        const Drive start = drive(car, stop.states.back(), 1.0, 5.0, 20.0);
        EXPECT_GT(start.states.back().speed_mps, 5.0);
        // Without gear changes, the start to 5 m/s takes 5 s plus the lag of the torque. Lorries change gears before
        // they reach 5 m/s, so the limit is longer for each gear change.
        const double shifts_s = 2.0 * static_cast<double>(start.changes.size()) * car.settings.torque_interruption_s;
        EXPECT_LT(static_cast<double>(start.states.size()) * kStep_s, 7.0 + shifts_s);
    }
}

TEST(ElectricCar, NeverShiftsOrInterruptsTheTorque) {
    const Car car("electric_100kw");
    for (const double request : {0.5, 2.0, 9.0}) {
        const Drive start = drive(car, cruising(car, 0.0), request, 100.0 * kMpsPerKmh, 120.0);
        EXPECT_TRUE(start.changes.empty());
        for (std::size_t k = 50; k < start.states.size(); ++k) {
            ASSERT_GT(start.states[k].acceleration_mps2, 0.1) << "step " << k;
        }
    }
}

}  // namespace
}  // namespace stopline
