// Estimates the speed and the acceleration of the leader from radar: the Kalman filter with the model of Singer for
// dCACC (Ploeg et al. 2015, "Graceful degradation of cooperative adaptive cruise control"). In the model, the leader's
// acceleration is a random process with the correlation time 1 / alpha. Its variance follows from the largest
// acceleration, the probability of it, and the probability of no acceleration.
//
// The radar measures the closing speed; with the own speed, this is the leader's speed. The distance is not used: over
// the time constant of the filter, 25 ms, its noise of 29 mm would mean 1 m/s of noise in the speed. The gains are
// those that the filter reaches after a few steps, so a vehicle stores no covariances.
#pragma once

namespace stopline {

struct LeaderFilter {
    double speed_share = 0.0;  // change of the predicted speed per acceleration in a step, s
    double decay = 0.0;        // share of the acceleration that is left after a step
    double speed_gain = 0.0;   // correction of the speed per error of the predicted speed
    double acceleration_gain_1ps = 0.0;
};
LeaderFilter make_leader_filter(double step_s);

struct LeaderEstimate {
    float speed_mps = 0.0F;
    float acceleration_mps2 = 0.0F;
};

// Advances the estimate by one step, to the time of a new measurement of the leader's speed.
inline void update_estimate(const LeaderFilter& filter, double measured_mps, LeaderEstimate& estimate) {
    constexpr double kTiny_mps2 = 1e-6;  // smaller values would become subnormal, which is slow
    const double a = estimate.acceleration_mps2;
    const double predicted_mps = static_cast<double>(estimate.speed_mps) + filter.speed_share * a;
    const double error_mps = measured_mps - predicted_mps;
    const double corrected_mps2 = filter.decay * a + filter.acceleration_gain_1ps * error_mps;
    estimate.speed_mps = static_cast<float>(predicted_mps + filter.speed_gain * error_mps);
    estimate.acceleration_mps2 =
        corrected_mps2 < kTiny_mps2 && corrected_mps2 > -kTiny_mps2 ? 0.0F : static_cast<float>(corrected_mps2);
}

}  // namespace stopline
