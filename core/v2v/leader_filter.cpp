#include "v2v/leader_filter.h"

#include <cmath>

namespace stopline {

LeaderFilter make_leader_filter(double step_s) {
    // The values of Ploeg et al. 2015.
    constexpr double kAlpha_1ps = 1.25;
    constexpr double kLargest_mps2 = 3.0;
    constexpr double kLargestProbability = 0.01;
    constexpr double kZeroProbability = 0.1;
    constexpr double kSpeedNoise_mps = 0.017;
    const double variance = kLargest_mps2 * kLargest_mps2 / 3.0 * (1.0 + 4.0 * kLargestProbability - kZeroProbability);
    LeaderFilter f;
    f.decay = std::exp(-kAlpha_1ps * step_s);
    f.speed_share = (1.0 - f.decay) / kAlpha_1ps;
    // Covariance of the process noise of one step (Singer 1970), for speed and acceleration.
    const double e1 = f.decay;
    const double e2 = e1 * e1;
    const double a = kAlpha_1ps;
    const double noise_vv = variance / (a * a) * (4.0 * e1 - 3.0 - e2 + 2.0 * a * step_s);
    const double noise_va = variance / a * (e2 + 1.0 - 2.0 * e1);
    const double noise_aa = variance * (1.0 - e2);
    const double measured = kSpeedNoise_mps * kSpeedNoise_mps;
    // Covariance of the estimate after a measurement, from the start until it no longer changes.
    double vv = measured;
    double va = 0.0;
    double aa = variance;
    constexpr int kSteps = 2000;
    for (int k = 0; k < kSteps; ++k) {
        const double s = f.speed_share;
        const double predicted_vv = vv + 2.0 * s * va + s * s * aa + noise_vv;
        const double predicted_va = f.decay * (va + s * aa) + noise_va;
        const double predicted_aa = f.decay * f.decay * aa + noise_aa;
        f.speed_gain = predicted_vv / (predicted_vv + measured);
        f.acceleration_gain_1ps = predicted_va / (predicted_vv + measured);
        vv = (1.0 - f.speed_gain) * predicted_vv;
        va = (1.0 - f.speed_gain) * predicted_va;
        aa = predicted_aa - f.acceleration_gain_1ps * predicted_va;
    }
    return f;
}

}  // namespace stopline
