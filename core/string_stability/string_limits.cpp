#include "string_stability/string_limits.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/nan.h"

namespace stopline {

GainPeak peak_gain(const Follower& follower, const FrequencyRange& range) {
    constexpr int kPoints = 600;
    const double span = std::log(range.high_radps / range.low_radps);
    const auto peak_at = [&](double place) {
        const double frequency_radps = range.low_radps * std::exp(span * place / kPoints);
        return GainPeak{std::abs(follower.response(frequency_radps).to_leader), frequency_radps};
    };
    GainPeak best;
    int best_place = 0;
    for (int k = 0; k <= kPoints; ++k) {
        const GainPeak peak = peak_at(k);
        if (peak.gain > best.gain) best = peak, best_place = k;
    }
    // Golden-section search between the two neighbours of the best point.
    constexpr double kShare = std::numbers::phi - 1.0;
    double low = std::max(0, best_place - 1);
    double high = std::min(kPoints, best_place + 1);
    for (int k = 0; k < 30; ++k) {
        const GainPeak left = peak_at(high - kShare * (high - low));
        const GainPeak right = peak_at(low + kShare * (high - low));
        (left.gain > right.gain ? high : low) =
            left.gain > right.gain ? low + kShare * (high - low) : high - kShare * (high - low);
        for (const GainPeak& peak : {left, right}) {
            if (peak.gain > best.gain) best = peak;
        }
    }
    return best;
}

bool is_string_stable(const Follower& follower, const FrequencyRange& range) {
    return peak_gain(follower, range).gain <= 1.0 + kGainTolerance;
}

double smallest_stable_time_gap_s(FollowerModel model, const FrequencyRange& range) {
    constexpr double kShortest_s = 0.001;
    constexpr double kLongest_s = 20.0;
    constexpr double kPrecision_s = 1e-5;
    const auto holds = [&](double time_gap_s) {
        model.time_gap_s = time_gap_s;
        return is_string_stable(Follower(model), range);
    };
    if (!holds(kLongest_s)) return kNan;
    double low_s = kShortest_s;
    double high_s = kLongest_s;
    while (high_s - low_s > kPrecision_s) {
        const double middle_s = 0.5 * (low_s + high_s);
        (holds(middle_s) ? high_s : low_s) = middle_s;
    }
    return high_s;
}

double doubling_followers(double gain) {
    if (gain <= 1.0 + kGainTolerance) return std::numeric_limits<double>::infinity();
    return std::numbers::ln2 / std::log(gain);
}

}  // namespace stopline
