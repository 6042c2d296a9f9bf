// Measures of string stability from the motion of a platoon. Position 0 is the platoon leader, position 1 its first
// follower.
#pragma once

#include <complex>
#include <cstddef>
#include <vector>

#include "runs/strings/platoon_run.h"

namespace stopline {

// Measures of one vehicle during a manoeuvre. L2 is the root of the sum of squares, L-infinity the largest absolute
// value. A ratio compares a vehicle with its leader or with the platoon leader.
struct PositionMeasures {
    double l2_mps2 = 0.0;    // root mean square of the acceleration
    double linf_mps2 = 0.0;  // largest absolute acceleration
    double l2_ratio = 0.0;   // NaN for the platoon leader, as all other ratios and gaps
    double linf_ratio = 0.0;
    double l2_from_head = 0.0;
    double linf_from_head = 0.0;
    double gap_error_m = 0.0;     // largest absolute gap error
    double smallest_gap_m = 0.0;  // smallest net gap
    double used_share = 0.0;  // share of the standstill gap that was used up: 1 - smallest gap / standstill gap, >= 0
    double largest_jerk_mps3 = 0.0;  // while the vehicle is not stopped: the last moment of a stop has an endless jerk
};

struct StringMeasures {
    std::vector<PositionMeasures> positions;
    double smallest_gap_m = 0.0;
    double largest_gap_error_m = 0.0;
    double largest_used_share = 0.0;
    double largest_jerk_mps3 = 0.0;
    int first_growing_position = 0;  // first position whose L-infinity ratio exceeds 1 by kRatioTolerance; 0: none
    // Number of followers whose L-infinity norm is at most kDoubled times that of the platoon leader. The count ends in
    // front of the first exception.
    int holding_followers = 0;
};

inline constexpr double kRatioTolerance = 1e-3;
// A swing grows if its gain exceeds 1 by more than this. The measured gain of one vehicle is as exact as that.
inline constexpr double kSwingTolerance = 2e-4;
inline constexpr double kDoubled = 2.0;
// Jerk is the change of the acceleration within this time, divided by this time. Shorter times would show the steps of
// the torque at gear changes.
inline constexpr double kJerkTime_s = 0.1;

StringMeasures measure_string(const PlatoonMotion& motion);

// Returns the complex amplitude of each vehicle's acceleration at an angular frequency. The motion must last a whole
// number of periods.
std::vector<std::complex<double>> amplitudes(const PlatoonMotion& motion, double frequency_radps);

// The gain of a swing is measured from the front as far as the amplitude stays within bounds. Below kSmallestShare of
// the platoon leader's amplitude, the steps of the torque hide the oscillation. Above the two other bounds, the limits
// of acceleration and jerk act, and the gain depends on the amplitude.
inline constexpr double kSmallestShare = 0.02;
inline constexpr double kLargestAmplitude_mps2 = 1.0;
inline constexpr double kLargestSwingJerk_mps3 = 2.5;

// The gain |Gamma| of one vehicle in a swing.
struct SwingGain {
    // Geometric mean of the positions from 2 on. If position 2 is out of bounds, it is the gain of position 1.
    double mean = 0.0;
    double largest = 0.0;
    double first = 0.0;  // position 1
};
SwingGain swing_gain(const std::vector<std::complex<double>>& amplitudes, double frequency_radps);

}  // namespace stopline
