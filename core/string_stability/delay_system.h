// A linear system with delays, and its exact frequency response. The state x and the input w obey
//     dx/dt (t) = sum_k  A_k x(t - delay_k) + B_k w(t - delay_k)
// In the frequency domain a delay is a factor exp(-s delay), so no approximation of the delays is needed.
#pragma once

#include <complex>
#include <vector>

namespace stopline {

class DelaySystem {
public:
    // A system with `states` state variables and `inputs` input signals, at most kMaxSize of each.
    DelaySystem(int states, int inputs);

    // Adds gain * x[state](t - delay_s) to the derivative of x[row].
    void add_state(int row, int state, double gain, double delay_s = 0.0);
    // Adds gain * w[input](t - delay_s) to the derivative of x[row].
    void add_input(int row, int input, double gain, double delay_s = 0.0);

    // Returns the Laplace transforms of all state variables at s, for the given transforms of the input signals.
    std::vector<std::complex<double>> states(std::complex<double> s,
                                             const std::vector<std::complex<double>>& inputs) const;

    // Returns the number of characteristic roots with a positive real part, by the argument principle (Mikhailov's
    // criterion). The system is stable if this number is 0. No root may lie on the imaginary axis.
    int unstable_roots() const;

    static constexpr int kMaxSize = 8;

private:
    struct Term {
        int row;
        int column;
        double gain;
        double delay_s;
    };

    // Throws std::logic_error if the row is not a state, or if `column` is not below `columns`.
    void check(int row, int column, int columns) const;
    std::complex<double> characteristic(std::complex<double> s) const;

    int states_;
    int inputs_;
    std::vector<Term> state_terms_;
    std::vector<Term> input_terms_;
};

}  // namespace stopline
