// The vehicles that adapt their speed to an event ahead: a lane change, their own or that of another vehicle, or the
// start of green (sim/speed_advice).
#pragma once

namespace stopline {

// A vehicle that adapts its speed to a gap in the adjacent lane, opens a gap for a vehicle of the adjacent lane, or
// slows down to arrive at green. It drives no faster than its target.
struct SpeedTarget {
    static constexpr double kDeceleration_mps2 = 2.0;
    static constexpr double kTimeToTarget_s = 1.0;  // full dynamics: the acceleration is the speed error over this time

    int slot = -1;
    double target_speed_mps = 0.0;
    double deceleration_mps2 = kDeceleration_mps2;  // strongest braking towards the target speed
};

}  // namespace stopline
