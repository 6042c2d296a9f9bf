#include "string_stability/kalman_filter.h"

#include <complex>

#include <Eigen/Dense>

namespace stopline {

namespace {

using Matrix3 = Eigen::Matrix<double, kEstimatedStates, kEstimatedStates>;

// Returns the stabilising solution P of  A P + P A' + Q - P G P = 0. The columns of the matrix (X, P X) span the
// eigenvectors of the Hamiltonian matrix whose eigenvalues have a negative real part.
Matrix3 riccati_solution(const Matrix3& a, const Matrix3& q, const Matrix3& g) {
    constexpr int kN = kEstimatedStates;
    Eigen::Matrix<double, 2 * kN, 2 * kN> hamiltonian;
    hamiltonian << a.transpose(), -g, -q, -a;
    const Eigen::EigenSolver<Eigen::Matrix<double, 2 * kN, 2 * kN>> solver(hamiltonian);
    Eigen::Matrix<std::complex<double>, 2 * kN, kN> stable;
    int columns = 0;
    for (int k = 0; k < 2 * kN && columns < kN; ++k) {
        if (solver.eigenvalues()[k].real() < 0.0) stable.col(columns++) = solver.eigenvectors().col(k);
    }
    return (stable.bottomRows<kN>() * stable.topRows<kN>().inverse()).real();
}

}  // namespace

double SingerModel::variance_m2ps4() const {
    return largest_acceleration_mps2 * largest_acceleration_mps2 / 3.0 *
           (1.0 + 4.0 * largest_probability - zero_probability);
}

SteadyKalmanFilter steady_kalman_filter(const SingerModel& model) {
    Matrix3 a;
    a << 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, -model.manoeuvre_rate_1ps;
    Eigen::Matrix<double, 2, kEstimatedStates> measured;
    measured << 1.0, 0.0, 0.0, 0.0, 1.0, 0.0;
    const Eigen::Vector2d precision(1.0 / (model.position_noise_m * model.position_noise_m),
                                    1.0 / (model.speed_noise_mps * model.speed_noise_mps));
    Matrix3 noise = Matrix3::Zero();
    noise(2, 2) = 2.0 * model.manoeuvre_rate_1ps * model.variance_m2ps4();
    const Matrix3 covariance = riccati_solution(a, noise, measured.transpose() * precision.asDiagonal() * measured);
    const Eigen::Matrix<double, kEstimatedStates, 2> gain = covariance * measured.transpose() * precision.asDiagonal();
    const Matrix3 transition = a - gain * measured;
    SteadyKalmanFilter filter;
    for (int row = 0; row < kEstimatedStates; ++row) {
        const auto r = static_cast<std::size_t>(row);
        for (int k = 0; k < kEstimatedStates; ++k)
            filter.transition[r][static_cast<std::size_t>(k)] = transition(row, k);
        for (int k = 0; k < 2; ++k) filter.gain[r][static_cast<std::size_t>(k)] = gain(row, k);
    }
    return filter;
}

}  // namespace stopline
