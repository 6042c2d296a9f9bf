// The steady state of the Kalman filter with which a vehicle estimates the acceleration of its leader from radar.
#pragma once

#include <array>

namespace stopline {

// Singer's model of the leader's motion, and the noise of the radar. The values are those of Ploeg, Semsar-Kazerooni,
// Lijster, van de Wouw, Nijmeijer 2015, "Graceful degradation of cooperative adaptive cruise control".
struct SingerModel {
    double manoeuvre_rate_1ps = 1.25;        // alpha, inverse of the correlation time of the acceleration
    double largest_acceleration_mps2 = 3.0;  // a_max
    double largest_probability = 0.01;       // P_max: probability of a_max, and that of -a_max
    double zero_probability = 0.1;           // P_0: probability of no acceleration
    double position_noise_m = 0.029;         // standard deviation of the measured position
    double speed_noise_mps = 0.017;          // standard deviation of the measured speed

    // Returns the variance of the acceleration, m2/s4.
    double variance_m2ps4() const;
};

inline constexpr int kEstimatedStates = 3;  // position, speed, acceleration

// The filter  d estimate/dt = transition * estimate + gain * (measured position, measured speed).
struct SteadyKalmanFilter {
    std::array<std::array<double, kEstimatedStates>, kEstimatedStates> transition{};
    std::array<std::array<double, 2>, kEstimatedStates> gain{};
};

// Returns the filter after its transient. The covariance of the error then solves the algebraic Riccati equation.
SteadyKalmanFilter steady_kalman_filter(const SingerModel& model);

}  // namespace stopline
