// Stop signs and all-way stops.
#pragma once

#include "sim/junction/candidate.h"
#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Returns where candidate `v` must wait because its connection has a stop rule; no wait if it may go on. A vehicle
// stops at the stop line first. At an all-way stop it then waits for all vehicles that stopped earlier at the stop
// line of a conflicting connection, or goes together with a vehicle for which these wait. `line_m`: waiting position
// at the stop line, along the connection. Stores in the vehicle's record when it has stopped.
Wait stop_sign_wait(const Model& model, State& state, int lane, const Candidate& v, double line_m);

}  // namespace stopline
