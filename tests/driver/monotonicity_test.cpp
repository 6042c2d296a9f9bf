// Tests of the acceleration laws. A larger gap never gives a smaller acceleration, and a higher closing speed never
// gives a larger one. All accelerations are finite in every state.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "driver/acceleration_laws.h"
#include "scenario/load_scenario.h"
#include "spacing_laws/gap_policy.h"

namespace stopline {
namespace {

const std::vector<double> kSpeeds{0.0, 1e-9, 0.05, 1.0, 5.0, 8.34, 14.0, 20.0};
const std::vector<double> kClosings{-20.0, -5.0, -1.0, -0.1, -1e-6, 0.0,  1e-6, 0.05,
                                    0.1,   0.5,  1.0,  2.0,  5.0,   10.0, 14.0};
const std::vector<double> kGaps{-1.0, 0.0,  1e-9, 0.1, 0.3, 0.55, 0.6,  0.8,  1.0,  1.5,   2.0,
                                2.9,  2.95, 3.0,  4.0, 6.0, 10.0, 15.0, 30.0, 60.0, 150.0, 1e6};
const std::vector<double> kAccelerations{-7.0, -3.0, -0.5, 0.0, 1.0, 2.5};

// Acceleration as a function of gap and closing speed. All other inputs are fixed.
using AccelerationLaw = std::function<double(double gap_m, double closing_mps)>;

void expect_monotone(const AccelerationLaw& acceleration, const std::string& case_name) {
    for (const double closing : kClosings) {
        for (std::size_t k = 1; k < kGaps.size(); ++k) {
            ASSERT_GE(acceleration(kGaps[k], closing), acceleration(kGaps[k - 1], closing) - 1e-12)
                << case_name << ": smaller at gap " << kGaps[k] << " than at " << kGaps[k - 1] << ", closing "
                << closing;
        }
    }
    for (const double gap : kGaps) {
        for (std::size_t k = 1; k < kClosings.size(); ++k) {
            ASSERT_LE(acceleration(gap, kClosings[k]), acceleration(gap, kClosings[k - 1]) + 1e-12)
                << case_name << ": larger at closing " << kClosings[k] << " than at " << kClosings[k - 1] << ", gap "
                << gap;
        }
    }
}

DriverTables shipped() { return compile_driver(load_driver("startup_kit")); }

TEST(Follow, IsMonotoneForEveryPolicy) {
    const CaccSettings cacc = shipped().cacc;
    for (const GapPolicySettings& policy : load_policies()) {
        for (const double v : kSpeeds) {
            double gap_m = 0.0;
            double slope_s = 0.0;
            make_gap_policy(policy).evaluate({&v, 1}, {&gap_m, 1}, {&slope_s, 1});
            for (const double a : {-3.0, 0.0, 2.0}) {
                for (const double a_p : kAccelerations) {
                    const auto acceleration = [&](double gap, double closing) {
                        const LeaderView<double> p{gap, closing, a_p, 0.5 * a_p, 4.0};
                        return follow_acceleration<double>(cacc, v, a, 0.2, 5.0, a, gap_m,
                                                           gap_m - policy.standstill_gap_m, slope_s, p, 0.01);
                    };
                    expect_monotone(acceleration, policy.name);
                }
            }
        }
    }
}

TEST(Follow, IsZeroInEquilibrium) {
    const CaccSettings cacc = shipped().cacc;
    for (const auto& [slope, growth] : {std::pair{0.0, 0.0}, {0.87, 8.7}, {0.87, 1.0}}) {
        const LeaderView<double> p{7.0, 0.0, 0.0, 0.0, 4.0};
        EXPECT_EQ(follow_acceleration<double>(cacc, 10.0, 0.0, 0.2, 5.0, 0.0, 7.0, growth, slope, p, 0.01), 0.0);
    }
}

TEST(Follow, StaysWithinTheComfortLimits) {
    const CaccSettings cacc = shipped().cacc;
    for (const auto& [slope, growth] : {std::pair{0.0, 0.0}, {0.87, 8.7}, {0.87, 1.0}}) {
        const LeaderView<double> far{1e6, -20.0, 2.0, 2.5, 4.0};
        const LeaderView<double> near{-10.0, 20.0, -7.0, -7.0, 4.0};
        EXPECT_LE(follow_acceleration<double>(cacc, 10.0, 0.0, 0.2, 5.0, 0.0, 7.0, growth, slope, far, 0.01),
                  cacc.acceleration_max_mps2);
        EXPECT_GE(follow_acceleration<double>(cacc, 10.0, 0.0, 0.2, 5.0, 0.0, 7.0, growth, slope, near, 0.01),
                  -cacc.deceleration_comfort_mps2);
    }
}

TEST(Emergency, IsMonotone) {
    const CaccSettings cacc = shipped().cacc;
    for (const double v : kSpeeds) {
        for (const double a_p : kAccelerations) {
            const auto acceleration = [&](double gap, double closing) {
                return emergency_acceleration<double>(cacc, v, {gap, closing, a_p, 0.0, 4.0});
            };
            expect_monotone(acceleration, "emergency at " + std::to_string(v));
        }
    }
}

// The emergency law is either inactive, and then returns more than 100 m/s2, or it brakes at least as hard as the
// situation requires.
TEST(Emergency, BrakesEnoughOrNotAtAll) {
    const CaccSettings c = shipped().cacc;
    for (double v = 1.0; v < 20.0; v += 1.0) {
        for (double gap = 2.0; gap < 80.0; gap += 1.0) {
            const double acceleration =
                emergency_acceleration<double>(c, v, {gap, v, 0.0, 0.0, 4.0});  // a stopped leader
            const double room_m = gap - c.radar_delay_s * v - c.emergency_gap_m;
            const double needed = room_m > 0.0 ? v * v / (2.0 * room_m) : 1e9;
            if (needed < c.emergency_threshold_mps2) {
                EXPECT_GT(acceleration, 100.0);
            } else {
                EXPECT_LE(acceleration, -std::fmin(needed, c.deceleration_emergency_mps2));
                EXPECT_GE(acceleration, -c.deceleration_emergency_mps2);
            }
        }
    }
}

// Returns the smallest distance between a follower and its leader while both brake to a stop. The follower brakes from
// speed v with deceleration b, the leader from v_p with b_p. The distance at the start is `room_m`.
double smallest_room_m(double v, double b, double v_p, double b_p, double room_m) {
    constexpr double kStep_s = 1e-3;
    const double until_s = std::fmax(v / b, v_p / b_p);
    const auto distance_driven = [](double speed_mps, double deceleration_mps2, double time_s) {
        const double braking_s = std::fmin(time_s, speed_mps / deceleration_mps2);
        return speed_mps * braking_s - 0.5 * deceleration_mps2 * braking_s * braking_s;
    };
    double smallest_m = room_m;
    for (double t = 0.0; t < until_s + kStep_s; t += kStep_s) {
        smallest_m = std::fmin(smallest_m, room_m + distance_driven(v_p, b_p, t) - distance_driven(v, b, t));
    }
    return smallest_m;
}

// Behind a braking leader, a follower brakes only as hard as the distance requires, not with its maximum.
TEST(Emergency, BrakesOnlyAsHardAsABrakingLeaderRequires) {
    const CaccSettings c = shipped().cacc;
    int moving_leader_cases = 0;
    int stopped_leader_cases = 0;
    for (const double v : {5.0, 9.0, 14.0}) {
        for (const double closing : {0.2, 1.0, 3.0, 5.0}) {
            for (const double b_p : {1.0, 3.0, 5.0, 7.0}) {
                for (const double room_m : {0.5, 1.0, 2.0, 5.0, 12.0}) {
                    const double gap = room_m + c.radar_delay_s * closing + c.emergency_gap_m;
                    const double acceleration = emergency_acceleration<double>(c, v, {gap, closing, -b_p, -b_p, 4.0});
                    const double sufficient =
                        acceleration > 100.0 ? c.emergency_threshold_mps2 : -acceleration / kEmergencyMargin;
                    if (acceleration <= -c.deceleration_emergency_mps2) continue;  // already at maximum braking
                    EXPECT_GE(smallest_room_m(v, sufficient, v - closing, b_p, room_m), -1e-3)
                        << v << closing << b_p << room_m;
                    if (acceleration > 100.0) continue;
                    (2.0 * room_m / closing < (v - closing) / b_p ? moving_leader_cases : stopped_leader_cases) += 1;
                    EXPECT_LT(smallest_room_m(v, 0.99 * sufficient, v - closing, b_p, room_m), 0.0)
                        << v << closing << b_p << room_m;
                }
            }
        }
    }
    EXPECT_GT(moving_leader_cases, 3);
    EXPECT_GT(stopped_leader_cases, 20);
}

TEST(KeepRoom, IsMonotone) {
    const CaccSettings cacc = shipped().cacc;
    for (const double v : kSpeeds) {
        for (const double a_p : kAccelerations) {
            for (const double gap_growth_m : {0.0, 2.0, 12.0}) {
                const auto acceleration = [&](double gap, double closing) {
                    return keep_room_acceleration<double>(cacc, v, gap_growth_m, {gap, closing, a_p, 0.0, 4.0});
                };
                expect_monotone(acceleration, "keeping room at " + std::to_string(v));
            }
        }
    }
}

// If the follower (speed v) and the leader (speed v_p) both brake with b, a distance of (v^2 - v_p^2) / (2 b) between
// them just suffices. keep_room_acceleration() starts to brake at this distance plus a reserve and the emergency gap.
TEST(KeepRoom, StartsWhereEqualBrakingJustSuffices) {
    const CaccSettings c = shipped().cacc;
    const double b = c.deceleration_emergency_mps2;
    for (double v_p = 0.0; v_p < 15.0; v_p += 1.0) {
        for (double closing = 0.25; closing < 6.0; closing += 0.25) {
            const double v = v_p + closing;
            const double room_m = (v * v - v_p * v_p) / (2.0 * b);
            if (room_m < 0.1) continue;  // for less than 0.05 m the law computes with 0.05 m
            for (const double gap_growth_m : {0.0, 1.0, 12.0}) {
                const double min_reserve_m = gap_growth_m > 0.0 ? kMinReserve_s * v : 0.0;
                const double reserve_m =
                    (c.radar_delay_s + kBrakeResponse_s) * closing +
                    std::max(std::min(kBrakeResponse_s * v, kReservedGrowthShare * gap_growth_m), min_reserve_m);
                const double limit_m = room_m + reserve_m + c.emergency_gap_m;
                const auto acceleration = [&](double gap_m) {
                    return keep_room_acceleration<double>(c, v, gap_growth_m, {gap_m, closing, 1.0, 1.0, 4.0});
                };
                EXPECT_GT(acceleration(limit_m + 0.01), 100.0) << v << ' ' << closing;
                EXPECT_LT(acceleration(limit_m - 0.01), -0.9 * b * closing / v) << v << ' ' << closing;
                EXPECT_GE(acceleration(0.0), -b);
            }
        }
    }
}

TEST(Stop, IsMonotoneInDistanceAndSpeed) {
    const DriverTables d = shipped();
    const std::vector<double> distances{-1.0, -1e-9, 0.0, 1e-9, 0.01, 0.1, 1.0, 5.0, 20.0, 100.0, 1e6};
    for (std::size_t k = 1; k < distances.size(); ++k) {
        for (const double v : kSpeeds) {
            EXPECT_GE(stop_acceleration(d, v, distances[k]), stop_acceleration(d, v, distances[k - 1])) << v;
        }
    }
    for (const double distance : distances) {
        for (std::size_t k = 1; k < kSpeeds.size(); ++k) {
            EXPECT_LE(stop_acceleration(d, kSpeeds[k], distance), stop_acceleration(d, kSpeeds[k - 1], distance));
        }
    }
}

// The follower is accelerating when its leader begins to brake. The law normally smooths its request with a filter,
// which delays braking. If the leader brakes hard and the gap is too short for this delay, the law must brake at once.
TEST(Follow, PassesHardBrakingUnfilteredAtSmallGaps) {
    const CaccSettings cacc = shipped().cacc;
    const auto acceleration = [&](double gap_growth_m, double slope_s, double request_mps2, double room_m = 0.0) {
        const LeaderView<double> p{2.95 + room_m, 0.0, 0.0, request_mps2, 4.0};
        return follow_acceleration<double>(cacc, 9.0, 1.0, 0.2, 5.0, 1.0, 2.95 + gap_growth_m, gap_growth_m, slope_s, p,
                                           0.01);
    };
    EXPECT_EQ(acceleration(0.5, 0.87, -7.0), -cacc.deceleration_comfort_mps2) << "SWITCH-1 just above 30 km/h";
    EXPECT_GT(acceleration(0.5, 0.87, -1.9), 0.9) << "gentle braking";
    EXPECT_EQ(acceleration(7.8, 3.3, -7.0), -cacc.deceleration_comfort_mps2)
        << "the desired gap grows fast with speed and is not reached yet";
    EXPECT_GT(acceleration(7.8, 0.87, -7.0, 7.8), 0.8) << "the time gap leaves room";
    EXPECT_GT(acceleration(7.8, 0.87, -7.0, 5.0), 0.7) << "part of the time gap suffices";
    EXPECT_EQ(acceleration(0.0, 0.0, -7.0), -cacc.deceleration_comfort_mps2) << "a constant distance";
}

TEST(AccelerationLaws, AreFinite) {
    const DriverTables d = shipped();
    for (const double v : kSpeeds) {
        EXPECT_TRUE(std::isfinite(free_acceleration(d, v, 0.0)) && std::isfinite(free_acceleration(d, v, 1e3)));
        EXPECT_TRUE(std::isfinite(catch_up_acceleration(d, v, 14.0)));
        for (const double gap : kGaps) {
            EXPECT_TRUE(std::isfinite(stop_acceleration(d, v, gap)));
            EXPECT_TRUE(std::isfinite(slow_down_acceleration(d, v, 0.0, gap)));
            for (const double closing : kClosings) {
                for (const double rate : {0.1, 5.0, 1000.0}) {
                    for (const double slope : {0.0, 1e-12, 0.87}) {
                        const LeaderView<double> p{gap, closing, -7.0, 2.5, rate};
                        const double follow = follow_acceleration<double>(d.cacc, v, 1.0, 1.0 / rate, rate, -1.0, 3.0,
                                                                          1.0, slope, p, 0.01);
                        ASSERT_TRUE(std::isfinite(follow)) << gap << ' ' << closing << ' ' << rate << ' ' << slope;
                        ASSERT_TRUE(std::isfinite(emergency_acceleration(d.cacc, v, p)));
                        ASSERT_TRUE(std::isfinite(keep_room_acceleration(d.cacc, v, slope * v, p)));
                    }
                }
            }
        }
    }
}

}  // namespace
}  // namespace stopline
