// The keep-clear rule: a vehicle enters an intersection only if its exit lane has room for it and no stopped vehicle
// blocks its connection (driver/traffic_rules.h). Drivers apply the rule to what they see.
#pragma once

#include "base/containers/index.h"
#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Returns the slot of the first vehicle that the keep-clear rule holds before the line; -1: none. Stores the reason in
// StopLines::held_at_green: the exit lane has no room, a short exit lane has no room for all vehicles that will enter
// it (ShortExitCheck), or a stopped vehicle blocks the connection.
int choose_keep_clear_stop(const Model& model, State& state, int lane);

// Returns true if the vehicle can stop before the line if it brakes with `deceleration_mps2` after a response time
// (can_stop_after_response()).
bool can_stop(const Model& model, const VehicleArrays& v, int slot, double line_m, double deceleration_mps2);

// Returns true if the vehicle in `slot` of the approach lane `lane` can stop at the line. This is always so if it was
// held in the previous step: it may accelerate up to its braking curve, where the test of the distance would fail. Any
// other vehicle may brake with the peak deceleration of a normal stop, or with the comfortable deceleration if this is
// higher. The mesoscale mode has no brake lag, so no response time is added there to braking with the peak.
bool can_hold_for_keep_clear(const Model& model, const State& state, int lane, int slot);

// Returns the free room in an exit lane. The first call in a step computes the room, and later calls in the same step
// reuse it.
const ExitRoom& exit_room(const Model& model, State& state, int exit);

// Returns the slot of a stopped vehicle from a crossing street that must clear `connection` first; -1: none. Ignores
// connections that yield to `connection` or have priority over it, and vehicles that may be passed under the
// pass-blocker rule.
int crossing_blocker(const Model& model, const State& state, int connection);

// Returns the length that a vehicle takes in a queue: its own length plus its standstill gap, m.
inline double space_needed_m(const VehicleArrays& v, int slot) {
    return static_cast<double>(v.length_m[at(slot)]) + static_cast<double>(v.standstill_gap_m[at(slot)]);
}

}  // namespace stopline
