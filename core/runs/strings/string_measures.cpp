#include "runs/strings/string_measures.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/nan.h"
#include "base/speed_thresholds.h"

namespace stopline {

namespace {

PositionMeasures measure_position(const PlatoonMotion& motion, std::size_t position) {
    PositionMeasures one;
    const auto jerk_samples = static_cast<std::size_t>(std::max(1L, std::lround(kJerkTime_s / motion.step_s)));
    const auto acceleration = [&](std::size_t k) { return motion.value(motion.acceleration_mps2, k, position); };
    double squares = 0.0;
    one.smallest_gap_m = position == 0 ? kNan : motion.value(motion.gap_m, 0, position);
    for (std::size_t k = 0; k < motion.samples; ++k) {
        squares += acceleration(k) * acceleration(k);
        one.linf_mps2 = std::max(one.linf_mps2, std::abs(acceleration(k)));
        if (k >= jerk_samples && motion.value(motion.speed_mps, k, position) >= kStoppedSpeed_mps) {
            const double change_mps2 = std::abs(acceleration(k) - acceleration(k - jerk_samples));
            one.largest_jerk_mps3 =
                std::max(one.largest_jerk_mps3, change_mps2 / (static_cast<double>(jerk_samples) * motion.step_s));
        }
        if (position == 0) continue;
        one.gap_error_m = std::max(one.gap_error_m, std::abs(motion.value(motion.gap_error_m, k, position)));
        one.smallest_gap_m = std::min(one.smallest_gap_m, motion.value(motion.gap_m, k, position));
    }
    one.l2_mps2 = std::sqrt(squares / static_cast<double>(motion.samples));
    if (position == 0) one.gap_error_m = kNan;
    one.used_share = position == 0 ? kNan : std::max(0.0, 1.0 - one.smallest_gap_m / motion.standstill_gap_m[position]);
    return one;
}

}  // namespace

StringMeasures measure_string(const PlatoonMotion& motion) {
    StringMeasures string;
    for (std::size_t position = 0; position < motion.vehicles; ++position) {
        string.positions.push_back(measure_position(motion, position));
        PositionMeasures& one = string.positions.back();
        string.largest_jerk_mps3 = std::max(string.largest_jerk_mps3, one.largest_jerk_mps3);
        if (position == 0) {
            one.l2_ratio = one.linf_ratio = one.l2_from_head = one.linf_from_head = kNan;
            continue;
        }
        const PositionMeasures& leader = string.positions[position - 1];
        const PositionMeasures& head = string.positions[0];
        one.l2_ratio = one.l2_mps2 / leader.l2_mps2;
        one.linf_ratio = one.linf_mps2 / leader.linf_mps2;
        one.l2_from_head = one.l2_mps2 / head.l2_mps2;
        one.linf_from_head = one.linf_mps2 / head.linf_mps2;
        const int place = static_cast<int>(position);
        if (string.first_growing_position == 0 && one.linf_ratio > 1.0 + kRatioTolerance) {
            string.first_growing_position = place;
        }
        if (string.holding_followers == place - 1 && one.linf_from_head <= kDoubled) string.holding_followers = place;
        string.smallest_gap_m =
            position == 1 ? one.smallest_gap_m : std::min(string.smallest_gap_m, one.smallest_gap_m);
        string.largest_gap_error_m = std::max(string.largest_gap_error_m, one.gap_error_m);
        string.largest_used_share = std::max(string.largest_used_share, one.used_share);
    }
    return string;
}

std::vector<std::complex<double>> amplitudes(const PlatoonMotion& motion, double frequency_radps) {
    std::vector<std::complex<double>> sums(motion.vehicles);
    for (std::size_t k = 0; k < motion.samples; ++k) {
        const std::complex<double> wave = std::polar(2.0 / static_cast<double>(motion.samples),
                                                     -frequency_radps * static_cast<double>(k) * motion.step_s);
        for (std::size_t position = 0; position < motion.vehicles; ++position) {
            sums[position] += motion.value(motion.acceleration_mps2, k, position) * wave;
        }
    }
    return sums;
}

SwingGain swing_gain(const std::vector<std::complex<double>>& amplitudes, double frequency_radps) {
    const double largest_mps2 = std::min(kLargestAmplitude_mps2, kLargestSwingJerk_mps3 / frequency_radps);
    SwingGain gain;
    gain.first = std::abs(amplitudes[1]) / std::abs(amplitudes[0]);
    std::size_t last = 1;
    for (std::size_t k = 1; k < amplitudes.size(); ++k) {
        const bool is_weak = std::abs(amplitudes[k]) < kSmallestShare * std::abs(amplitudes[0]);
        if (k > 1 && (is_weak || std::abs(amplitudes[k]) > largest_mps2)) break;
        gain.largest = std::max(gain.largest, std::abs(amplitudes[k]) / std::abs(amplitudes[k - 1]));
        last = k;
    }
    gain.mean =
        last == 1 ? gain.first
                  : std::pow(std::abs(amplitudes[last]) / std::abs(amplitudes[1]), 1.0 / static_cast<double>(last - 1));
    return gain;
}

}  // namespace stopline
