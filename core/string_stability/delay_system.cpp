#include "string_stability/delay_system.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include <Eigen/Dense>

namespace stopline {

namespace {

using Complex = std::complex<double>;
// Small matrices on the stack. A frequency response needs many thousand of them.
using ComplexMatrix = Eigen::Matrix<Complex, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, DelaySystem::kMaxSize,
                                    DelaySystem::kMaxSize>;
using ComplexVector = Eigen::Matrix<Complex, Eigen::Dynamic, 1, Eigen::ColMajor, DelaySystem::kMaxSize, 1>;

// Returns s I - sum_k A_k exp(-s delay_k).
template <class Terms>
ComplexMatrix characteristic_matrix(int states, const Terms& terms, Complex s) {
    ComplexMatrix matrix = s * ComplexMatrix::Identity(states, states);
    for (const auto& term : terms) matrix(term.row, term.column) -= term.gain * std::exp(-s * term.delay_s);
    return matrix;
}

}  // namespace

DelaySystem::DelaySystem(int states, int inputs) : states_(states), inputs_(inputs) {
    if (states < 1 || states > kMaxSize || inputs < 1 || inputs > kMaxSize) {
        throw std::logic_error("a DelaySystem has too many states or inputs");
    }
}

void DelaySystem::check(int row, int column, int columns) const {
    if (row < 0 || row >= states_ || column < 0 || column >= columns) {
        throw std::logic_error("a DelaySystem has no such state or input");
    }
}

void DelaySystem::add_state(int row, int state, double gain, double delay_s) {
    check(row, state, states_);
    if (gain != 0.0) state_terms_.push_back({row, state, gain, delay_s});
}

void DelaySystem::add_input(int row, int input, double gain, double delay_s) {
    check(row, input, inputs_);
    if (gain != 0.0) input_terms_.push_back({row, input, gain, delay_s});
}

std::vector<Complex> DelaySystem::states(Complex s, const std::vector<Complex>& inputs) const {
    ComplexVector excitation = ComplexVector::Zero(states_);
    for (const Term& term : input_terms_) {
        excitation(term.row) +=
            term.gain * std::exp(-s * term.delay_s) * inputs.at(static_cast<std::size_t>(term.column));
    }
    const ComplexVector solution = characteristic_matrix(states_, state_terms_, s).partialPivLu().solve(excitation);
    return {solution.data(), solution.data() + solution.size()};
}

Complex DelaySystem::characteristic(Complex s) const {
    return characteristic_matrix(states_, state_terms_, s).determinant();
}

// Let n be the number of states. Along the imaginary axis from 0 to infinity, the argument of the characteristic
// function grows by (n / 2 - N) pi, if N roots have a positive real part.
int DelaySystem::unstable_roots() const {
    constexpr double kLowest_radps = 1e-5;
    constexpr double kHighest_radps = 1e5;
    constexpr int kPoints = 20'000;
    const double ratio = std::pow(kHighest_radps / kLowest_radps, 1.0 / kPoints);
    double argument = 0.0;
    Complex before = characteristic({0.0, 0.0});
    for (int k = 0; k <= kPoints; ++k) {
        const Complex now = characteristic({0.0, kLowest_radps * std::pow(ratio, k)});
        argument += std::arg(now / before);
        before = now;
    }
    return static_cast<int>(std::lround(0.5 * states_ - argument / std::numbers::pi));
}

}  // namespace stopline
