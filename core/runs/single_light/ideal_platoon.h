// An ideal platoon: each follower keeps the gap of its policy at all times, without a controller, delay or acceleration
// limit. The speed of the platoon leader over time is given. The result is the best discharge that a spacing policy
// allows behind this platoon leader. A simulated platoon discharges differently because of its controllers and
// powertrains.
//
//     front_{i-1}(t) - length_{i-1} - front_i(t) = gap_i(v_i(t)),   dfront_i / dt = v_i >= 0
//
// The platoon starts as a queue with standstill gaps. The equations are solved with backward Euler steps of
// kIdealStep_s. Each step finds the speed v with v dt + gap(v) = d. Here d is the net gap of a vehicle after the
// vehicle ahead has moved, but before the vehicle itself moves. The left side increases with v, so there is one
// solution.
#pragma once

#include <span>
#include <vector>

#include "scenario/scenario.h"

namespace stopline {

// One sample of the leader's speed. Samples are in the order of time, from 0 s on. The speed is interpolated linearly
// and stays constant after the last sample.
struct SpeedSample {
    double time_s = 0.0;
    double speed_mps = 0.0;
};

// A vehicle of the platoon.
struct IdealVehicle {
    const GapPolicySettings* policy;
    double length_m;
};

inline constexpr double kIdealStep_s = 0.01;

// Returns the times at which the fronts of the vehicles pass a line, s, in the order of the platoon. Passages after
// `until_s` are left out. `vehicles` begins with the leader. `to_line_m` is the initial distance from the front of the
// leader to the line.
std::vector<double> ideal_passages_s(std::span<const SpeedSample> leader, const std::vector<IdealVehicle>& vehicles,
                                     double to_line_m, double until_s);

}  // namespace stopline
