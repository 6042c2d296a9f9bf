// Predicts when the next vehicle reaches a conflict area, and finds vehicles that are blocked or yielding themselves.
// All functions read the state at the beginning of the step.
#pragma once

#include "base/speed_thresholds.h"
#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

inline constexpr double kNoArrival_s = 1e9;

// Returns true if the vehicle is slower than kCrawlingSpeed_mps and had to yield before a conflict area in this step or
// the last one. Such a vehicle is not expected to arrive: the vehicles that it waits for go first.
bool is_yielding(const State& state, int slot);

// Returns true if the vehicle is yielding at or before `area_m`, a position along its connection. A vehicle that yields
// further on still enters an area that begins before its waiting position.
bool is_yielding_before(const State& state, int slot, double area_m);

// Returns true if the vehicle and its leader are both slower than kCrawlingSpeed_mps and close together. Neither the
// vehicle nor its followers are then expected to arrive.
bool is_blocked_by_leader(const State& state, int slot);

// Returns true if a queue of slow vehicles leads from an occupant of connection `lane` to a yielding vehicle ahead. The
// yielding vehicle may be on another connection that shares the stretch behind the stop line.
bool is_behind_yielding_vehicle(const State& state, int lane, const JunctionOccupant& occupant);

// Returns the time in s to cover a distance while accelerating up to the speed limit.
double earliest_arrival_s(double distance_m, double speed_mps, double acceleration_mps2, double limit_mps);

// The next vehicle to reach a conflict area, and the earliest time at which it can be there.
struct Arrival {
    double time_s = kNoArrival_s;  // from now
    int slot = -1;                 // -1: no arrival

    void keep_earlier(double other_time_s, int other_slot) {
        if (other_time_s < time_s) *this = {other_time_s, other_slot};
    }
};
// Returns the next arrival on the other connection, from the connection itself, from before its stop line or from
// further upstream. Vehicles that will stop at the signal do not count. Upstream lanes are searched as far as
// `horizon_s`.
Arrival next_arrival(const Model& model, const State& state, const Conflict& conflict, double horizon_s);

}  // namespace stopline
