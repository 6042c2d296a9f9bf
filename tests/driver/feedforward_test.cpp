// Tests of the two feedforward terms of Fig. 3 and 4 in the paper. A feedforward term is the acceleration that a
// follower requests because its leader accelerates. Each vehicle realises its request with a lag. The predictive term
// solves a least-squares problem. The term for time gaps inverts the follower's lag and applies the leader's lag.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "base/random.h"
#include "driver/acceleration_laws.h"

namespace stopline {
namespace {

struct Problem {
    CaccSettings cacc;
    double own_mps2, own_rate_1ps;
    LeaderView<double> p;
};

Problem arbitrary_problem(std::uint64_t k) {
    const auto between = [&](std::uint64_t draw, double low, double high) {
        return low + (high - low) * random_uniform(3, k, draw, Purpose::dawdle);
    };
    Problem problem{};
    problem.cacc.prediction_start_s = between(0, 0.02, 0.3);
    problem.cacc.prediction_end_s = problem.cacc.prediction_start_s + between(1, 0.1, 0.8);
    problem.cacc.v2v_delay_s = between(2, 0.0, 0.15);
    problem.own_mps2 = between(3, -3.0, 2.0);
    problem.own_rate_1ps = 1.0 / between(4, 0.1, 0.6);
    problem.p.acceleration_mps2 = between(5, -3.0, 2.0);
    problem.p.request_mps2 = between(6, -3.0, 2.0);
    problem.p.rate_1ps = 1.0 / between(7, 0.1, 0.6);
    return problem;
}

// Sets up three equations w u = b. The unknown u is the acceleration that the follower requests. At each of three later
// times, the follower's acceleration shall equal the leader's. Uses std::exp, not the approximation of the tested code.
void equations(const Problem& q, Eigen::Vector3d& w, Eigen::Vector3d& b) {
    for (int k = 0; k < 3; ++k) {
        const double t = q.cacc.prediction_start_s + 0.5 * k * (q.cacc.prediction_end_s - q.cacc.prediction_start_s);
        const double own = std::exp(-t * q.own_rate_1ps);
        const double other = std::exp(-(t + q.cacc.v2v_delay_s) * q.p.rate_1ps);
        const double target = q.p.request_mps2 + (q.p.acceleration_mps2 - q.p.request_mps2) * other;
        w[k] = 1.0 - own;
        b[k] = target - own * q.own_mps2;
    }
}

double feedforward_of(const Problem& q) { return predictive_feedforward(q.cacc, q.own_mps2, q.own_rate_1ps, q.p); }

TEST(PredictiveFeedforward, IsTheLeastSquaresSolution) {
    for (std::uint64_t k = 0; k < 2000; ++k) {
        const Problem q = arbitrary_problem(k);
        Eigen::Vector3d w;
        Eigen::Vector3d b;
        equations(q, w, b);
        const Eigen::MatrixXd design = w;
        const double best = design.colPivHouseholderQr().solve(b)(0);
        const double limited =
            std::fmin(q.cacc.acceleration_max_mps2, std::fmax(-q.cacc.deceleration_emergency_mps2, best));
        ASSERT_NEAR(feedforward_of(q), limited, 1e-5) << "case " << k;
    }
}

TEST(PredictiveFeedforward, HasTheSmallestResidualOfAllRequests) {
    for (std::uint64_t k = 0; k < 200; ++k) {
        const Problem q = arbitrary_problem(k);
        Eigen::Vector3d w;
        Eigen::Vector3d b;
        equations(q, w, b);
        const double residual = (w * feedforward_of(q) - b).squaredNorm();
        for (double u = -q.cacc.deceleration_emergency_mps2; u <= q.cacc.acceleration_max_mps2; u += 0.01) {
            ASSERT_LE(residual, (w * u - b).squaredNorm() + 1e-9) << "case " << k << ", request " << u;
        }
    }
}

TEST(PredictiveFeedforward, EqualsTheRequestOfAnIdenticalLeader) {
    for (std::uint64_t k = 0; k < 200; ++k) {
        Problem q = arbitrary_problem(k);
        q.cacc.v2v_delay_s = 0.0;
        q.own_rate_1ps = q.p.rate_1ps;
        q.own_mps2 = q.p.acceleration_mps2;
        EXPECT_NEAR(feedforward_of(q), q.p.request_mps2, 1e-6);
    }
}

// Returns the largest gap error behind a manoeuvring leader, m. Both vehicles are first-order lags without delays, so
// an exact feedforward leaves no error. The time constants are tau_p for the leader and tau for the follower.
double largest_error_m(double tau_p, double tau, double kp, double kd) {
    constexpr double kStep_s = 0.001;
    constexpr double kTimeGap_s = 0.87;
    CaccSettings c;
    c.feedback_kp_1ps2 = kp;
    c.feedback_kd_1ps = kd;
    double a_p = 0.0;
    double closing = 0.0;
    double a = 0.0;
    double u = 0.0;
    double error_m = 0.0;
    double largest_m = 0.0;
    for (int k = 0; k * kStep_s < 40.0; ++k) {
        const double t = k * kStep_s;
        const double u_p = std::sin(0.9 * t) + (t > 15.0 && t < 18.0 ? 0.8 : -0.2);
        const LeaderView<double> p{10.0 + error_m, closing, a_p, u_p, 1.0 / tau_p};
        u = follow_acceleration<double>(c, 8.0, a, tau, 1.0 / tau, u, 10.0, 7.0, kTimeGap_s, p, kStep_s);
        const double a_previous = a;
        const double closing_previous = closing;
        const double a_p_previous = a_p;
        a += (u - a) * lag_share(kStep_s, tau);
        a_p += (u_p - a_p) * lag_share(kStep_s, tau_p);
        closing += 0.5 * (a + a_previous - a_p - a_p_previous) * kStep_s;
        // error = gap - r - h v with standstill gap r and time gap h, so it falls at the rate closing + h a.
        error_m -= 0.5 * (closing + closing_previous) * kStep_s + kTimeGap_s * 0.5 * (a + a_previous) * kStep_s;
        largest_m = std::fmax(largest_m, std::fabs(error_m));
    }
    return largest_m;
}

TEST(TimeGapFeedforward, InvertsTheOwnLagAndAppliesTheLeaders) {
    for (const double tau_p : {0.1, 0.25, 0.5}) {
        for (const double tau : {0.1, 0.25, 0.5}) {
            EXPECT_LT(largest_error_m(tau_p, tau, 0.2, 0.7), 0.01) << tau_p << ' ' << tau;
            EXPECT_LT(largest_error_m(tau_p, tau, 0.0, 0.0), 0.02) << "without feedback, " << tau_p << ' ' << tau;
        }
    }
}

}  // namespace
}  // namespace stopline
