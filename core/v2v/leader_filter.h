// Estimates the speed and the acceleration of the leader from radar: the Kalman filter with the model of Singer for
// dCACC (Ploeg et al. 2015, "Graceful degradation of cooperative adaptive cruise control"). In the model, the leader's
// acceleration is a random process with the correlation time 1 / alpha. Its variance follows from the largest
// acceleration, the probability of it, and the probability of no acceleration.
//
// The radar measures the closing speed; with the own speed, this is the leader's speed. The distance is not used: over
// the time constant of the filter, 25 ms, its noise of 29 mm would mean 1 m/s of noise in the speed. The gains are
// those that the filter reaches after a few steps, so a vehicle stores no covariances.
#pragma once

#include "base/simd/arithmetic.h"

namespace stopline {

struct LeaderFilter {
    double speed_share = 0.0;  // change of the predicted speed per acceleration in a step, s
    double decay = 0.0;        // share of the acceleration that is left after a step
    double speed_gain = 0.0;   // correction of the speed per error of the predicted speed
    double acceleration_gain_1ps = 0.0;
};
LeaderFilter make_leader_filter(double step_s);

// The number type D is double or Single for one vehicle, or Batch for several ones.
template <class D>
struct LeaderEstimateOf {
    D speed_mps;
    D acceleration_mps2;
};

// Advances the estimate by one step, to the time of a new measurement of the leader's speed.
template <class D>
STOPLINE_INLINE void update_estimate(const LeaderFilter& filter, const D& measured_mps, LeaderEstimateOf<D>& estimate) {
    constexpr double kTiny_mps2 = 1e-6;  // smaller values would become subnormal, which is slow
    const D a = estimate.acceleration_mps2;
    const D predicted_mps = estimate.speed_mps + filter.speed_share * a;
    const D error_mps = measured_mps - predicted_mps;
    const D corrected_mps2 = filter.decay * a + filter.acceleration_gain_1ps * error_mps;
    const D is_tiny = STOPLINE_FLAG(D, corrected_mps2 < kTiny_mps2) * STOPLINE_FLAG(D, corrected_mps2 > -kTiny_mps2);
    estimate.speed_mps = predicted_mps + filter.speed_gain * error_mps;
    estimate.acceleration_mps2 = choose(is_tiny, splat<D>(0.0), corrected_mps2);
}

}  // namespace stopline
