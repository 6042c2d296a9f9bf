// Cooperative clearing: the room on exit lanes, and its bookings.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Returns true if the vehicle takes part in cooperative clearing: its policy has V2V, and its latest announcement is
// fresh. Drivers treat all other vehicles as under the keep-clear rule.
bool cooperates(const Model& model, const State& state, int slot);

// Returns the slot after the last admitted vehicle of a lane. Vehicles past the stop line count as admitted.
int admitted_end(const State& state, int lane);

// Returns true if bookings apply to an exit lane: it ends at a signal, and a vehicle of this length fits before it.
// The keep-clear rule applies to all other exit lanes.
bool takes_bookings(const State& state, int exit, double length_m);

// Returns the bookings of an exit lane. The first call in a step determines them from the places of rest of the
// vehicles on the lane, from the vehicles on the connections to the lane, and from the admitted vehicles upstream.
// Later calls in the same step return the same object, so callers can add bookings.
ExitBooking& exit_booking(const Model& model, State& state, int exit);

}  // namespace stopline
