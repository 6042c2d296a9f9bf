// Limits of string stability that follow from the transfer function Gamma of one vehicle. A platoon of equal vehicles
// is string stable if |Gamma| is at most 1 at all frequencies (Ploeg et al. 2011). Otherwise an oscillation grows by
// the factor |Gamma| from vehicle to vehicle.
#pragma once

#include "string_stability/follower_model.h"

namespace stopline {

// A range of angular frequencies. The default covers all oscillations of traffic. Faster ones are beyond the limits of
// jerk and beyond the powertrain, where the linear model does not apply.
struct FrequencyRange {
    double low_radps = 0.01;
    double high_radps = 20.0;
};

struct GainPeak {
    double gain = 0.0;  // largest |Gamma|
    double frequency_radps = 0.0;
};

// |Gamma| may exceed 1 by this much. At low frequencies |Gamma| tends to 1 and is computed with rounding errors.
inline constexpr double kGainTolerance = 1e-6;

// Returns the largest |Gamma| of a vehicle behind its leader.
GainPeak peak_gain(const Follower& follower, const FrequencyRange& range = {});

// Returns true if |Gamma| is at most 1 in the range.
bool is_string_stable(const Follower& follower, const FrequencyRange& range = {});

// Returns the smallest time gap with which the platoon is string stable, by bisection. Returns NaN if no time gap up to
// 20 s suffices.
double smallest_stable_time_gap_s(FollowerModel model, const FrequencyRange& range = {});

// Returns the number of followers after which an oscillation with the worst frequency has doubled: ln 2 / ln gain. It
// is infinite if the gain does not exceed 1.
double doubling_followers(double gain);

}  // namespace stopline
