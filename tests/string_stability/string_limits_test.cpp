// Tests of the linear analysis against published values and closed forms.
#include "string_stability/string_limits.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>
#include <vector>

#include "driver/acceleration_laws.h"

namespace stopline {
namespace {

using Complex = std::complex<double>;

// A vehicle with an ideal radar, as in the publications.
FollowerModel vehicle(Topology topology, double time_gap_s, double lag_s, double v2v_delay_s) {
    FollowerModel model;
    model.topology = topology;
    model.cacc.radar_delay_s = 0.0;
    model.cacc.v2v_delay_s = v2v_delay_s;
    model.time_gap_s = time_gap_s;
    model.lag_s = lag_s;
    model.leader_lag_s = lag_s;
    return model;
}

// A vehicle with a constant distance whose feedforward is the request of the leader. The predictive feedforward tends
// to it for a horizon far beyond the lags.
FollowerModel distance_vehicle(double lag_s, double v2v_delay_s) {
    FollowerModel model = vehicle(Topology::leader, 0.0, lag_s, v2v_delay_s);
    model.cacc.prediction_start_s = 50.0;
    model.cacc.prediction_end_s = 60.0;
    return model;
}

TEST(StringLimits, SmallestTimeGapOfCacc) {
    // Delay of V2V and smallest time gap, s.
    constexpr std::array<std::array<double, 2>, 8> kExpected{{{0.02, 0.243},
                                                              {0.06, 0.422},
                                                              {0.10, 0.547},
                                                              {0.15, 0.672},
                                                              {0.20, 0.779},
                                                              {0.30, 0.961},
                                                              {0.44, 1.174},
                                                              {0.50, 1.256}}};
    for (const auto& [delay_s, time_gap_s] : kExpected) {
        EXPECT_NEAR(smallest_stable_time_gap_s(vehicle(Topology::leader, 0.0, 0.1, delay_s)), time_gap_s,
                    0.03 * time_gap_s)
            << delay_s;
    }
}

TEST(StringLimits, SmallestTimeGapOfAcc) {
    // Ploeg et al. 2011 give 3.16 s.
    EXPECT_NEAR(smallest_stable_time_gap_s(vehicle(Topology::radar, 0.0, 0.1, 0.0)), 3.16, 0.005);
}

TEST(StringLimits, SmallestTimeGapWithAnEstimatedAcceleration) {
    EXPECT_NEAR(smallest_stable_time_gap_s(vehicle(Topology::estimated_leader, 0.0, 0.1, 0.0)), 1.15, 0.05 * 1.15);
    EXPECT_NEAR(smallest_stable_time_gap_s(vehicle(Topology::estimated_leader, 0.0, 0.3, 0.0)), 1.23, 0.05 * 1.23);
}

TEST(StringLimits, FollowersUntilAnOscillationHasDoubled) {
    struct Case {
        double delay_s, lag_s, followers;
    };
    for (const Case& c : {Case{0.02, 0.1, 47}, Case{0.02, 0.3, 43}, Case{0.05, 0.1, 19}, Case{0.05, 0.3, 17},
                          Case{0.10, 0.1, 9}, Case{0.10, 0.3, 8}, Case{0.15, 0.1, 6}, Case{0.15, 0.3, 6}}) {
        const GainPeak peak = peak_gain(Follower(distance_vehicle(c.lag_s, c.delay_s)));
        EXPECT_NEAR(std::floor(doubling_followers(peak.gain)), c.followers, 1.0) << c.delay_s << ' ' << c.lag_s;
        EXPECT_GT(peak.gain, 1.0);
    }
    EXPECT_NEAR(doubling_followers(std::sqrt(2.0)), 2.0, 1e-12);
    EXPECT_TRUE(std::isinf(doubling_followers(0.9)));
}

TEST(StringLimits, GapErrorsDoNotGrowWithThePlatoonLeader) {
    constexpr int kFollowers = 42;
    constexpr double kRounding_m = 1e-12;
    for (const double delay_s : {0.02, 0.05, 0.1}) {
        for (const double lag_s : {0.1, 0.3}) {
            const Follower follower(vehicle(Topology::leader_and_platoon_leader, 0.0, lag_s, delay_s));
            EXPECT_TRUE(is_string_stable(follower));
            for (double frequency_radps = 0.01; frequency_radps < 20.0; frequency_radps *= 1.02) {
                const PlatoonResponse platoon = follower.platoon_response(frequency_radps, kFollowers);
                for (std::size_t k = 2; k <= kFollowers; ++k) {
                    ASSERT_LE(std::abs(platoon.gap_error_m[k]), std::abs(platoon.gap_error_m[k - 1]) + kRounding_m)
                        << frequency_radps << " rad/s, follower " << k;
                }
            }
        }
    }
}

TEST(Follower, EqualsTheClosedFormOfATimeGap) {
    // Gamma = (G K + D) / (H (1 + G K)) with G = 1 / (s^2 (lag s + 1)), K = kp + kd s, H = 1 + h s.
    const double time_gap_s = 0.7;
    const double lag_s = 0.25;
    const double delay_s = 0.06;
    FollowerModel model = vehicle(Topology::leader, time_gap_s, lag_s, delay_s);
    model.leader_lag_s = 0.4;  // the feedforward takes the lag of the leader into account
    const Follower follower(model);
    for (const double frequency_radps : {0.05, 0.4, 1.3, 5.0}) {
        const Complex s(0.0, frequency_radps);
        const Complex loop = (0.2 + 0.7 * s) / (s * s * (lag_s * s + 1.0));
        const Complex expected = (loop + std::exp(-delay_s * s)) / ((1.0 + time_gap_s * s) * (1.0 + loop));
        EXPECT_NEAR(std::abs(follower.response(frequency_radps).to_leader - expected), 0.0, 1e-9) << frequency_radps;
    }
}

TEST(Follower, EqualsTheClosedFormOfAConstantDistance) {
    const double lag_s = 0.3;
    const double delay_s = 0.05;
    const double radar_s = 0.15;
    FollowerModel model = distance_vehicle(lag_s, delay_s);
    model.cacc.radar_delay_s = radar_s;
    const Follower follower(model);
    for (const double frequency_radps : {0.05, 0.4, 1.3, 5.0}) {
        const Complex s(0.0, frequency_radps);
        const Complex feedback = (0.2 + 0.7 * s) * std::exp(-radar_s * s) / (s * s);
        const Complex expected = (feedback + std::exp(-delay_s * s) * (lag_s * s + 1.0)) / (lag_s * s + 1.0 + feedback);
        EXPECT_NEAR(std::abs(follower.response(frequency_radps).to_leader - expected), 0.0, 1e-6) << frequency_radps;
    }
}

// The response in the time domain: two vehicles with first-order lags and the laws of full dynamics, behind a leader
// that oscillates. It checks the signs and delays of the model, with the predictive feedforward of the paper.
TEST(Follower, EqualsAnIntegrationInTime) {
    constexpr double kStep_s = 0.0005;
    constexpr double kLag_s = 0.2;
    constexpr double kFrequency_radps = 1.2;
    FollowerModel model = vehicle(Topology::leader, 0.0, kLag_s, 0.1);
    model.cacc.radar_delay_s = 0.15;
    const auto delayed = [&](const std::vector<double>& signal, double delay_s) {
        const auto steps = static_cast<std::size_t>(std::lround(delay_s / kStep_s));
        return signal.size() > steps ? signal[signal.size() - 1 - steps] : 0.0;
    };
    std::vector<double> gap{10.0}, closing{0.0}, leader_a{0.0}, leader_u{0.0};
    double a = 0.0;
    Complex own_wave = 0.0;
    Complex leader_wave = 0.0;
    const double period_s = 2.0 * std::numbers::pi / kFrequency_radps;
    const int steps = static_cast<int>(std::lround(40.0 * period_s / kStep_s));
    for (int k = 0; k < steps; ++k) {
        const double t = k * kStep_s;
        const LeaderView<double> p{delayed(gap, 0.15), delayed(closing, 0.15), delayed(leader_a, 0.1),
                                   delayed(leader_u, 0.1), 1.0 / kLag_s};
        const double u =
            follow_acceleration<double>(model.cacc, 15.0, a, kLag_s, 1.0 / kLag_s, 0.0, 10.0, 0.0, 0.0, p, kStep_s);
        if (k >= steps / 2) {
            const Complex wave = std::exp(Complex(0.0, -kFrequency_radps * t));
            own_wave += a * wave;
            leader_wave += leader_a.back() * wave;
        }
        const double u_p = 0.5 * std::sin(kFrequency_radps * t);
        const double a_p = leader_a.back();
        gap.push_back(gap.back() - closing.back() * kStep_s);
        closing.push_back(closing.back() + (a - a_p) * kStep_s);
        leader_u.push_back(u_p);
        leader_a.push_back(a_p + (u_p - a_p) * kStep_s / kLag_s);
        a += (u - a) * kStep_s / kLag_s;
    }
    const Complex expected = Follower(model).response(kFrequency_radps).to_leader;
    EXPECT_NEAR(std::abs(own_wave / leader_wave - expected), 0.0, 0.01);
    EXPECT_GT(std::abs(expected - 1.0), 0.03);  // the case must differ from a perfect follower
}

TEST(Follower, KnowsWhenItsOwnLoopIsUnstable) {
    FollowerModel model = vehicle(Topology::radar, 1.0, 0.1, 0.0);
    EXPECT_TRUE(Follower(model).is_stable());
    model.cacc.radar_delay_s = 5.0;
    EXPECT_FALSE(Follower(model).is_stable());
    for (const Topology topology :
         {Topology::radar, Topology::estimated_leader, Topology::leader, Topology::leader_and_platoon_leader}) {
        FollowerModel shipped = vehicle(topology, 0.87, 0.2, 0.02);
        shipped.cacc.radar_delay_s = 0.15;
        EXPECT_TRUE(Follower(shipped).is_stable());
    }
    // s^2 (lag s + 1) + kd s + kp has roots with a positive real part if lag kp > kd (Hurwitz).
    FollowerModel distance = vehicle(Topology::radar, 0.0, 0.5, 0.0);
    distance.cacc.feedback_kd_1ps = 0.6 * distance.lag_s * distance.cacc.feedback_kp_1ps2;
    EXPECT_FALSE(Follower(distance).is_stable());
    distance.cacc.feedback_kd_1ps = 1.4 * distance.lag_s * distance.cacc.feedback_kp_1ps2;
    EXPECT_TRUE(Follower(distance).is_stable());
}

TEST(KalmanFilter, TransmitsConstantSpeedsWithoutError) {
    // At rest the estimate of the acceleration must be 0 for a constant position and for a constant speed: the filter
    // has no bias. transition * (p, v, 0) + gain * (p, v) = d/dt (p, v, 0) = (v, 0, 0).
    const SteadyKalmanFilter filter = steady_kalman_filter({});
    for (const auto& [p, v] : {std::pair{1.0, 0.0}, std::pair{3.0, 2.0}}) {
        for (std::size_t row = 0; row < kEstimatedStates; ++row) {
            const double change = filter.transition[row][0] * p + filter.transition[row][1] * v +
                                  filter.gain[row][0] * p + filter.gain[row][1] * v;
            EXPECT_NEAR(change, row == 0 ? v : 0.0, 1e-9);
        }
    }
}

}  // namespace
}  // namespace stopline
