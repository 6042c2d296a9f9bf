// Laws that lead along a curve of speed over distance or speed alone, driven by a vehicle that does at once what is asked.
#include <gtest/gtest.h>

#include <cmath>

#include "base/input_error.h"
#include "driver/acceleration_laws.h"
#include "scenario/load_scenario.h"
#include "vehicle/powertrain_tables.h"

namespace stopline {
namespace {

constexpr double kStep_s = 0.001;

DriverTables shipped() { return compile_driver(load_driver("startup_kit")); }

struct Arrival {
    double distance_m;  // left when it stands or gets there
    double speed_mps;
    double hardest_mps2;
};

template <class Law>
Arrival approach(double speed_mps, double distance_m, const Law& law) {
    Arrival now{distance_m, speed_mps, 0.0};
    for (int k = 0; k < 200'000 && now.speed_mps > 1e-3 && now.distance_m > -0.5; ++k) {
        const double a = law(now.speed_mps, now.distance_m);
        const double next = std::fmax(0.0, now.speed_mps + a * kStep_s);
        now.distance_m -= 0.5 * (now.speed_mps + next) * kStep_s;
        now.speed_mps = next;
        now.hardest_mps2 = std::fmin(now.hardest_mps2, a);
    }
    return now;
}

TEST(Stop, LandsOnTheSpotFromItsCurve) {
    const DriverTables d = shipped();
    for (double v = 0.5; v < 20.0; v += 0.5) {
        const double distance = stopping_distance_m(d, v);
        const Arrival end =
            approach(v, distance, [&](double speed, double left) { return stop_acceleration(d, speed, left); });
        EXPECT_NEAR(end.distance_m, 0.0, 0.01) << "from " << v << " m/s";
        EXPECT_GE(end.distance_m, -1e-6) << "overshoots";
        EXPECT_GT(end.hardest_mps2, -1.02 * d.stop.deceleration_mps2) << "brakes harder than its deceleration";
    }
}

// Too late for the curve: it brakes harder, as hard as the vehicle can, and still stops before the line.
TEST(Stop, CatchesUpWithItsCurveWhenLate) {
    const DriverTables d = shipped();
    for (double v = 2.0; v < 20.0; v += 1.0) {
        const double distance = v * v / (2.0 * 5.0) + 0.2;
        const Arrival end = approach(
            v, distance, [&](double speed, double left) { return std::fmax(-7.0, stop_acceleration(d, speed, left)); });
        EXPECT_GE(end.distance_m, -0.05) << "from " << v << " m/s";  // of the 1 m that it keeps to the line
    }
}

TEST(StoppingDistance, IsTheClosedForm) {
    DriverTables d = shipped();
    d.stop.deceleration_mps2 = 2.5;
    EXPECT_DOUBLE_EQ(stopping_distance_m(d, 10.0), 100.0 / 5.0 + 10.0 * kLandingTime_s);
    EXPECT_EQ(stopping_distance_m(d, 0.0), 0.0);
}

TEST(SlowDown, ReachesTheLowerLimitWhereItBegins) {
    const DriverTables d = shipped();
    const double end_mps = 7.0;
    for (const double v : {8.0, 10.0, 14.0, 20.0}) {
        const double distance = (v * v - end_mps * end_mps) / (2.0 * d.deceleration_mps2) + 5.0;
        Arrival now{distance, v, 0.0};
        while (now.distance_m > 0.0) {
            const double a = std::fmin(0.0, slow_down_acceleration(d, now.speed_mps, end_mps, now.distance_m));
            const double next = now.speed_mps + a * kStep_s;
            now.distance_m -= 0.5 * (now.speed_mps + next) * kStep_s;
            now.speed_mps = next;
            now.hardest_mps2 = std::fmin(now.hardest_mps2, a);
        }
        EXPECT_LE(now.speed_mps, end_mps + 0.01) << "from " << v;
        EXPECT_GE(now.speed_mps, end_mps - 0.3) << "from " << v;
        EXPECT_GT(now.hardest_mps2, -1.1 * d.deceleration_mps2);
    }
}

TEST(FreeDrive, FollowsTheProfileBelowAndTheGainNearTheDesiredSpeed) {
    const DriverSettings settings = load_driver("startup_kit");
    const DriverTables d = compile_driver(settings);
    const SampledCurve profile{settings.free_drive.speed_mps, settings.free_drive.acceleration_mps2};
    for (double v = 0.0; v < 30.0; v += 0.05) {
        // Its dents lie between the nodes of the grid.
        EXPECT_NEAR(free_acceleration(d, v, 1e6), interpolate(profile, v), 0.15) << v;
        EXPECT_LE(free_acceleration(d, v, 14.0), d.speed_gain_1ps * (14.0 - v) + 1e-12);
    }
    for (std::size_t node = 0; node < d.profile_mps2.size(); ++node) {
        const double v = static_cast<double>(node) / d.profile_nodes_per_mps;
        EXPECT_NEAR(free_acceleration(d, v, 1e6), interpolate(profile, v), 1e-9) << v;
    }
    EXPECT_EQ(free_acceleration(d, 14.0, 14.0), 0.0);
    EXPECT_LT(free_acceleration(d, 15.0, 14.0), 0.0);
    EXPECT_GT(catch_up_acceleration(d, 14.0, 14.0), 0.0);
    EXPECT_NEAR(catch_up_acceleration(d, 14.0 * d.cacc.catch_up_factor, 14.0), 0.0, 1e-12);
}

TEST(CompileDriver, RefusesAProfileWithoutOneAccelerationASpeed) {
    DriverSettings settings = load_driver("startup_kit");
    settings.free_drive.acceleration_mps2.pop_back();
    EXPECT_THROW(compile_driver(settings), InputError);
    settings.free_drive = {};
    EXPECT_THROW(compile_driver(settings), InputError);
}

TEST(CompileDriver, TakesAProfileOfOnePoint) {
    DriverSettings settings = load_driver("startup_kit");
    settings.free_drive.speed_mps = {0.0};
    settings.free_drive.acceleration_mps2 = {1.2};
    const DriverTables d = compile_driver(settings);
    for (const double v : {0.0, 0.5, 5.0, 50.0}) EXPECT_NEAR(free_acceleration(d, v, 1e6), 1.2, 1e-12);
}

}  // namespace
}  // namespace stopline
