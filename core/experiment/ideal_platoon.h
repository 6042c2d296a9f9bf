// Followers without a controller: each keeps the gap of its policy at every moment, without error, delay or limit of acceleration,
// behind a leader whose speed is given. What a spacing policy allows behind a given start, against which the simulated platoon can
// be checked; what differs is controller and powertrain.
//
//     front_{i-1}(t) - length - front_i(t) = gap_i(v_i(t)),   dfront_i / dt = v_i >= 0
//
// From a queue that stands at the gaps of standstill. Solved implicitly (backward Euler, kIdealStep_s), where each step asks for
// the speed v with  v dt + gap(v) = room  and  room = front_{i-1} - length - front_i before it moves; its left side grows with v.
#pragma once

#include <span>
#include <vector>

#include "scenario/scenario.h"

namespace stopline {

// The leader's way: samples in order of time, at times [s] from 0 on; the speed is linear between two of them, and constant after
// the last.
struct SpeedSample {
    double time_s = 0.0;
    double speed_mps = 0.0;
};

inline constexpr double kIdealStep_s = 0.01;

// Times [s] at which fronts pass a line, in the order of the platoon; those that pass later than `until_s` are left out.
// `policies`: of each vehicle, the leader's first (its own gap does not matter). `to_line_m` > 0: the leader's distance at first.
std::vector<double> ideal_passages_s(std::span<const SpeedSample> leader,
                                     const std::vector<const GapPolicySettings*>& policies, double length_m,
                                     double to_line_m, double until_s);

}  // namespace stopline
