// Predicts when the next vehicle reaches a conflict area. Finds vehicles that will not arrive soon, because they yield
// or are in a queue. All positions and speeds are those at the beginning of the step.
#pragma once

#include "base/containers/index.h"
#include "base/speed_thresholds.h"
#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

inline constexpr double kNoArrival_s = 1e9;

// Returns true if the vehicle had to wait before a conflict area or at a stop sign, in this step or the previous step.
inline bool had_to_wait(const State& state, int slot) {
    return state.vehicles.record[at(slot)].yield_tick >= state.tick - 1;
}

// Returns true if the vehicle had to wait (had_to_wait()) and is slower than kCrawlingSpeed_mps (1 m/s). A yielding
// vehicle is not expected to arrive soon, because it lets other vehicles go first.
bool is_yielding(const State& state, int slot);

// Returns true if the vehicle yields (is_yielding()) and the position where it waits is at or upstream of `area_m`, the
// start of a conflict area on its connection. A vehicle that waits further downstream still drives into the area.
bool is_yielding_before(const State& state, int slot, double area_m);

// Returns true if the vehicle and its leader are close together and both slower than kCrawlingSpeed_mps. Neither the
// vehicle nor its followers are expected to arrive soon.
bool is_blocked_by_leader(const State& state, int slot);

// Returns the range of the search for the leader of a queued vehicle beyond the end of the vehicle's lane, m.
double queue_look_ahead_m(const State& state, int slot);

// Returns true if `occupant`, a vehicle on connection `lane`, is in a queue of slow vehicles, and a vehicle further
// ahead in this queue yields. The yielding vehicle may also be on another connection from the same approach lane, but
// only on the part of that connection that overlaps with `lane`. Returns false if the front of the occupant is on the
// exit lane: the vehicles ahead of it are at the next intersection.
bool is_behind_yielding_vehicle(const State& state, int lane, const JunctionOccupant& occupant);

// Returns the time in s that a vehicle needs for a distance if it accelerates up to the speed limit. A vehicle above
// the limit keeps its speed.
double earliest_arrival_s(double distance_m, double speed_mps, double acceleration_mps2, double limit_mps);

// The next vehicle that reaches a conflict area, and its earliest possible arrival.
struct Arrival {
    double time_s = kNoArrival_s;  // time from the beginning of the step until the arrival
    int slot = -1;                 // slot of the vehicle; -1: no arrival

    void keep_earlier(double other_time_s, int other_slot) {
        if (other_time_s < time_s) *this = {other_time_s, other_slot};
    }
};

// How a yielding vehicle looks for the next arrival.
struct ArrivalSearch {
    double horizon_s = 0.0;          // time within which vehicles from further upstream can arrive
    double acceleration_mps2 = 0.0;  // assumed acceleration of arriving vehicles, up to the speed limit
    bool ignores_crawling = false;   // true: ignores all vehicles slower than kCrawlingSpeed_mps
};

// Returns the next arrival of a vehicle at the conflict area on connection `conflict.other`. The search covers the
// connection, its approach lane, and the lanes further upstream. It ignores vehicles that stop for the signal, are in a
// queue, or yield to others than intruders (YieldReason::intruder). In imported networks it also ignores vehicles that
// the keep-clear rule holds at rest. Vehicles behind an ignored vehicle, on the same connection or approach lane, are
// ignored, too.
Arrival next_arrival(const Model& model, const State& state, const Conflict& conflict, const ArrivalSearch& search);

}  // namespace stopline
