// Tests of laws that follow a curve of speed over distance or of acceleration over speed. The test vehicle realises
// each requested acceleration immediately.
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
    double distance_m;  // distance left at the end of the approach
    double speed_mps;
    double hardest_mps2;
};

template <class Law>
Arrival approach(double speed_mps, double distance_m, const Law& law) {
    Arrival state{distance_m, speed_mps, 0.0};
    for (int k = 0; k < 200'000 && state.speed_mps > 1e-3 && state.distance_m > -0.5; ++k) {
        const double a = law(state.speed_mps, state.distance_m);
        const double next = std::fmax(0.0, state.speed_mps + a * kStep_s);
        state.distance_m -= 0.5 * (state.speed_mps + next) * kStep_s;
        state.speed_mps = next;
        state.hardest_mps2 = std::fmin(state.hardest_mps2, a);
    }
    return state;
}

TEST(Stop, StopsAtTheTargetFromItsCurve) {
    const DriverTables d = shipped();
    for (double v = 0.5; v < 20.0; v += 0.5) {
        const double distance = stopping_distance_m(d, v);
        const Arrival arrival = approach(v, distance, [&](double speed, double distance_left_m) {
            return stop_acceleration(d, speed, distance_left_m);
        });
        EXPECT_NEAR(arrival.distance_m, 0.0, 0.01) << "from " << v << " m/s";
        EXPECT_GE(arrival.distance_m, -1e-6) << "overshoots";
        EXPECT_GT(arrival.hardest_mps2, -1.02 * d.stop.deceleration_mps2) << "brakes harder than its deceleration";
    }
}

// The vehicle starts braking too late for the curve. It brakes harder, up to its limit, and still stops in time.
TEST(Stop, BrakesHarderIfItStartsLate) {
    const DriverTables d = shipped();
    for (double v = 2.0; v < 20.0; v += 1.0) {
        const double distance = v * v / (2.0 * 5.0) + 0.2;
        const Arrival arrival = approach(v, distance, [&](double speed, double distance_left_m) {
            return std::fmax(-7.0, stop_acceleration(d, speed, distance_left_m));
        });
        // An overrun of 5 cm does no harm: in a run the target lies 1 m (stop.margin) before the stop line.
        EXPECT_GE(arrival.distance_m, -0.05) << "from " << v << " m/s";
    }
}

TEST(StoppingDistance, IsTheClosedForm) {
    DriverTables d = shipped();
    d.stop.deceleration_mps2 = 2.5;
    EXPECT_DOUBLE_EQ(stopping_distance_m(d, 10.0), 100.0 / 5.0 + 10.0 * kBrakingReaction_s);
    EXPECT_EQ(stopping_distance_m(d, 0.0), 0.0);
}

TEST(Deceleration, ReachesTheLowerLimitWhereItBegins) {
    const DriverTables d = shipped();
    const double end_mps = 7.0;
    for (const double v : {8.0, 10.0, 14.0, 20.0}) {
        const double distance = (v * v - end_mps * end_mps) / (2.0 * d.deceleration_mps2) + 5.0;
        Arrival state{distance, v, 0.0};
        while (state.distance_m > 0.0) {
            const double a = std::fmin(0.0, slow_down_acceleration(d, state.speed_mps, end_mps, state.distance_m));
            const double next = state.speed_mps + a * kStep_s;
            state.distance_m -= 0.5 * (state.speed_mps + next) * kStep_s;
            state.speed_mps = next;
            state.hardest_mps2 = std::fmin(state.hardest_mps2, a);
        }
        EXPECT_LE(state.speed_mps, end_mps + 0.01) << "from " << v;
        EXPECT_GE(state.speed_mps, end_mps - 0.3) << "from " << v;
        EXPECT_GT(state.hardest_mps2, -1.1 * d.deceleration_mps2);
    }
}

TEST(FreeDrive, FollowsTheProfileBelowAndTheGainNearTheDesiredSpeed) {
    const DriverSettings settings = load_driver("startup_kit");
    const DriverTables d = compile_driver(settings);
    const SampledCurve profile{settings.free_drive.speed_mps, settings.free_drive.acceleration_mps2};
    for (double v = 0.0; v < 30.0; v += 0.05) {
        // The tolerance covers kinks of the profile that lie between grid nodes.
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

TEST(CompileDriver, RefusesAProfileWithMissingValues) {
    DriverSettings settings = load_driver("startup_kit");
    settings.free_drive.acceleration_mps2.pop_back();
    EXPECT_THROW(compile_driver(settings), InputError);
    settings.free_drive = {};
    EXPECT_THROW(compile_driver(settings), InputError);
}

TEST(CompileDriver, AcceptsAProfileOfOnePoint) {
    DriverSettings settings = load_driver("startup_kit");
    settings.free_drive.speed_mps = {0.0};
    settings.free_drive.acceleration_mps2 = {1.2};
    const DriverTables d = compile_driver(settings);
    for (const double v : {0.0, 0.5, 5.0, 50.0}) EXPECT_NEAR(free_acceleration(d, v, 1e6), 1.2, 1e-12);
}

}  // namespace
}  // namespace stopline
