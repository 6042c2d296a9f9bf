// The answers to the driver's questions: no acceleration falls with a growing gap nor rises with closing speed, and all are
// finite in every state, however extreme.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "driver/acceleration_laws.h"
#include "driver/gap_policy.h"
#include "scenario/load_scenario.h"

namespace stopline {
namespace {

const std::vector<double> kSpeeds{0.0, 1e-9, 0.05, 1.0, 5.0, 8.34, 14.0, 20.0};
const std::vector<double> kClosings{-20.0, -5.0, -1.0, -0.1, -1e-6, 0.0,  1e-6, 0.05,
                                    0.1,   0.5,  1.0,  2.0,  5.0,   10.0, 14.0};
const std::vector<double> kGaps{-1.0, 0.0,  1e-9, 0.1, 0.3, 0.55, 0.6,  0.8,  1.0,  1.5,   2.0,
                                2.9,  2.95, 3.0,  4.0, 6.0, 10.0, 15.0, 30.0, 60.0, 150.0, 1e6};
const std::vector<double> kAccelerations{-7.0, -3.0, -0.5, 0.0, 1.0, 2.5};

// An answer as a function of gap and closing speed, everything else fixed.
using Answer = std::function<double(double gap_m, double closing_mps)>;

void expect_monotone(const Answer& answer, const std::string& where) {
    for (const double closing : kClosings) {
        for (std::size_t k = 1; k < kGaps.size(); ++k) {
            ASSERT_GE(answer(kGaps[k], closing), answer(kGaps[k - 1], closing) - 1e-12)
                << where << ": less at gap " << kGaps[k] << " than at " << kGaps[k - 1] << ", closing " << closing;
        }
    }
    for (const double gap : kGaps) {
        for (std::size_t k = 1; k < kClosings.size(); ++k) {
            ASSERT_LE(answer(gap, kClosings[k]), answer(gap, kClosings[k - 1]) + 1e-12)
                << where << ": more at closing " << kClosings[k] << " than at " << kClosings[k - 1] << ", gap " << gap;
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
            find_gap_law(policy.law).evaluate(policy, {&v, 1}, {&gap_m, 1}, {&slope_s, 1});
            for (const double a : {-3.0, 0.0, 2.0}) {
                for (const double a_p : kAccelerations) {
                    const auto answer = [&](double gap, double closing) {
                        const PredecessorView<double> p{gap, closing, a_p, 0.5 * a_p, 4.0};
                        return follow_acceleration<double>(cacc, v, a, 0.2, 5.0, a, gap_m,
                                                           gap_m - policy.standstill_gap_m, slope_s, p, 0.01);
                    };
                    expect_monotone(answer, policy.name);
                }
            }
        }
    }
}

TEST(Follow, IsNothingInEquilibrium) {
    const CaccSettings cacc = shipped().cacc;
    for (const auto& [slope, growth] : {std::pair{0.0, 0.0}, {0.87, 8.7}, {0.87, 1.0}}) {
        const PredecessorView<double> p{7.0, 0.0, 0.0, 0.0, 4.0};
        EXPECT_EQ(follow_acceleration<double>(cacc, 10.0, 0.0, 0.2, 5.0, 0.0, 7.0, growth, slope, p, 0.01), 0.0);
    }
}

TEST(Follow, KeepsToComfort) {
    const CaccSettings cacc = shipped().cacc;
    for (const auto& [slope, growth] : {std::pair{0.0, 0.0}, {0.87, 8.7}, {0.87, 1.0}}) {
        const PredecessorView<double> far{1e6, -20.0, 2.0, 2.5, 4.0};
        const PredecessorView<double> near{-10.0, 20.0, -7.0, -7.0, 4.0};
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
            const auto answer = [&](double gap, double closing) {
                return emergency_acceleration<double>(cacc, v, {gap, closing, a_p, 0.0, 4.0});
            };
            expect_monotone(answer, "emergency at " + std::to_string(v));
        }
    }
}

// Either it does not matter, or it brakes at least as the situation needs.
TEST(Emergency, BrakesEnoughOrNotAtAll) {
    const CaccSettings c = shipped().cacc;
    for (double v = 1.0; v < 20.0; v += 1.0) {
        for (double gap = 2.0; gap < 80.0; gap += 1.0) {
            const double answer = emergency_acceleration<double>(c, v, {gap, v, 0.0, 0.0, 4.0});  // it stands
            const double room_m = gap - c.radar_delay_s * v - c.emergency_gap_m;
            const double needed = room_m > 0.0 ? v * v / (2.0 * room_m) : 1e9;
            if (needed < c.emergency_threshold_mps2) {
                EXPECT_GT(answer, 100.0);
            } else {
                EXPECT_LE(answer, -std::fmin(needed, c.deceleration_emergency_mps2));
                EXPECT_GE(answer, -c.deceleration_emergency_mps2);
            }
        }
    }
}

// The least room between two that brake evenly from `v` and `v_p`, with b and b_p, from `room_m`; in small steps of time.
double least_room_m(double v, double b, double v_p, double b_p, double room_m) {
    constexpr double kStep_s = 1e-3;
    const double until_s = std::fmax(v / b, v_p / b_p);
    const auto driven = [](double from, double with, double t) {
        const double braked = std::fmin(t, from / with);
        return from * braked - 0.5 * with * braked * braked;
    };
    double least = room_m;
    for (double t = 0.0; t < until_s + kStep_s; t += kStep_s) {
        least = std::fmin(least, room_m + driven(v_p, b_p, t) - driven(v, b, t));
    }
    return least;
}

// One that follows with a time gap does not brake with all it has because the one ahead does: only as hard as the room asks for.
TEST(Emergency, BrakesAsHardAsABrakingPredecessorAsksFor) {
    const CaccSettings c = shipped().cacc;
    int meet = 0;
    int stop = 0;
    for (const double v : {5.0, 9.0, 14.0}) {
        for (const double slower : {0.2, 1.0, 3.0, 5.0}) {
            for (const double b_p : {1.0, 3.0, 5.0, 7.0}) {
                for (const double room_m : {0.5, 1.0, 2.0, 5.0, 12.0}) {
                    const double gap = room_m + c.radar_delay_s * slower + c.emergency_gap_m;
                    const double answer = emergency_acceleration<double>(c, v, {gap, slower, -b_p, -b_p, 4.0});
                    const double enough = answer > 100.0 ? c.emergency_threshold_mps2 : -answer / kEmergencyMargin;
                    if (answer <= -c.deceleration_emergency_mps2) continue;  // it does what it can
                    EXPECT_GE(least_room_m(v, enough, v - slower, b_p, room_m), -1e-3) << v << slower << b_p << room_m;
                    if (answer > 100.0) continue;
                    (2.0 * room_m / slower < (v - slower) / b_p ? meet : stop) += 1;
                    EXPECT_LT(least_room_m(v, 0.99 * enough, v - slower, b_p, room_m), 0.0)
                        << v << slower << b_p << room_m;
                }
            }
        }
    }
    EXPECT_GT(meet, 3);
    EXPECT_GT(stop, 20);
}

TEST(KeepRoom, IsMonotone) {
    const CaccSettings cacc = shipped().cacc;
    for (const double v : kSpeeds) {
        for (const double a_p : kAccelerations) {
            for (const double growth_m : {0.0, 2.0, 12.0}) {
                const auto answer = [&](double gap, double closing) {
                    return keep_room_acceleration<double>(cacc, v, growth_m, {gap, closing, a_p, 0.0, 4.0});
                };
                expect_monotone(answer, "keeping room at " + std::to_string(v));
            }
        }
    }
}

// Two vehicles that brake alike, from where the law begins to ask for something: the one behind just touches.
TEST(KeepRoom, BeginsWhereBrakingAlikeWouldJustBeEnough) {
    const CaccSettings c = shipped().cacc;
    const double b = c.deceleration_emergency_mps2;
    for (double v_p = 0.0; v_p < 15.0; v_p += 1.0) {
        for (double closing = 0.25; closing < 6.0; closing += 0.25) {
            const double v = v_p + closing;
            const double room_m = (v * v - v_p * v_p) / (2.0 * b);
            if (room_m < 0.1) continue;  // less than 0.05 m does not count as less
            for (const double growth_m : {0.0, 1.0, 12.0}) {
                const double least_m = growth_m > 0.0 ? kLeastReserve_s * v : 0.0;
                const double reserve_m = (c.radar_delay_s + kBrakeReserve_s) * closing +
                                         std::max(std::min(kBrakeReserve_s * v, kReservedGrowth * growth_m), least_m);
                const double just_m = room_m + reserve_m + c.emergency_gap_m;
                const auto answer = [&](double gap_m) {
                    return keep_room_acceleration<double>(c, v, growth_m, {gap_m, closing, 1.0, 1.0, 4.0});
                };
                EXPECT_GT(answer(just_m + 0.01), 100.0) << v << ' ' << closing;
                EXPECT_LT(answer(just_m - 0.01), -0.9 * b * closing / v) << v << ' ' << closing;
                EXPECT_GE(answer(0.0), -b);
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

// One that goes faster and faster when its predecessor is told to brake with all it has.
TEST(Follow, HardBrakingIsNotFilteredWhereThereIsLittleRoom) {
    const CaccSettings cacc = shipped().cacc;
    const auto answer = [&](double growth_m, double slope_s, double request_mps2, double room_m = 0.0) {
        const PredecessorView<double> p{2.95 + room_m, 0.0, 0.0, request_mps2, 4.0};
        return follow_acceleration<double>(cacc, 9.0, 1.0, 0.2, 5.0, 1.0, 2.95 + growth_m, growth_m, slope_s, p, 0.01);
    };
    EXPECT_EQ(answer(0.5, 0.87, -7.0), -cacc.deceleration_comfort_mps2) << "SWITCH-1 just above 30 km/h";
    EXPECT_GT(answer(0.5, 0.87, -1.9), 0.9) << "not hard";
    EXPECT_EQ(answer(7.8, 3.3, -7.0), -cacc.deceleration_comfort_mps2) << "a gap that grows fast, and is not there yet";
    EXPECT_GT(answer(7.8, 0.87, -7.0, 7.8), 0.8) << "a time gap leaves room";
    EXPECT_GT(answer(7.8, 0.87, -7.0, 5.0), 0.7) << "part of it does, too";
    EXPECT_EQ(answer(0.0, 0.0, -7.0), -cacc.deceleration_comfort_mps2) << "a constant distance";
}

TEST(EveryAnswer, IsFinite) {
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
                        const PredecessorView<double> p{gap, closing, -7.0, 2.5, rate};
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
