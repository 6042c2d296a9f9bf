// Who comes to a conflict area, and when; who stands and will not come. From the state at the beginning of the step.
#pragma once

#include "sim/phases.h"

namespace stopline {

inline constexpr double kNeverComes_s = 1e9;
inline constexpr double kAlmostStands_mps = 1.0;  // or slower

// Stands and waits for others itself: it will not come before they have gone, and they may be waiting for who asks.
bool held(const State& state, int slot);

// The same, before an area: one may wait for others beyond the beginning of an area, and go into it until there.
bool held_before(const State& state, int slot, double area_m);

// Stands right behind a vehicle that stands: it will not come, nor will those behind it.
bool blocked(const State& state, int slot);

// The same of one past the stop line on the way to `lane`, where the first of those that stand in front waits for others;
// maybe to go another way from the stretch that they share.
bool behind_held(const State& state, int lane, const Insider& who);

// Time to cover a distance, accelerating up to the limit.
double earliest_s(double distance_m, double speed_mps, double acceleration_mps2, double limit_mps);

// When the next vehicle of the other lane, inside or before its stop line, can be at the conflict area; those that will stop
// at the light do not count. Looks no further ahead than `horizon_s`.
struct Arrival {
    double in_s = kNeverComes_s;
    int slot = -1;

    void earlier(double in, int who) {
        if (in < in_s) *this = {in, who};
    }
};
Arrival next_arrival(const Model& model, const State& state, const Conflict& conflict, double horizon_s);

}  // namespace stopline
