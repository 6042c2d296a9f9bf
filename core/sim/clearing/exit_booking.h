// Cooperative clearing: the room on exit lanes, and its bookings.
#pragma once

#include "sim/clearing/received_messages.h"
#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Returns true if the vehicle takes part in cooperative clearing: its policy has V2V. All other vehicles obey the
// keep-clear rule.
bool has_v2v(const State& state, int slot);

// Returns the slot after the last admitted vehicle of a lane. Vehicles past the stop line count as admitted.
int admitted_end(const State& state, int lane);

// Returns true if bookings apply to an exit lane: it ends at a signal, and a vehicle of this length fits before it.
// The keep-clear rule applies to all other exit lanes.
bool takes_bookings(const State& state, int exit, double length_m);

// Returns the bookings of an exit lane. The first call in a step determines them from the places of rest of the
// vehicles on the lane, from the vehicles on the connections to the lane, and from the admitted vehicles upstream.
// Later calls in the same step return the same object, so callers can add bookings.
ExitBooking& exit_booking(const Model& model, State& state, int exit);

// The room on its exit lane as a vehicle knows it from the messages that it has received. Without a V2V channel, this
// is the ExitBooking.
struct KnownRoom {
    bool is_fresh = true;  // false: the vehicle has missed the messages of the last second
    double room_m = 0.0;
    double present_room_m = 0.0;
    double start_s = 0.0;
};
KnownRoom known_room(const Model& model, State& state, const Listener& listener);

}  // namespace stopline
