// Stop signs and all-way stops.
#pragma once

#include "sim/junction/candidate.h"
#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Returns where `candidate` must wait because of the stop rule of its connection; no wait if it may go on. Each
// vehicle first stops at the stop line. At an all-way stop it then waits for the vehicles on conflicting connections
// that stopped at their lines earlier. Exception: the candidate may go together with a third vehicle that has just
// started, if the third vehicle conflicts with the vehicle that stopped earlier but not with the candidate. Stores in
// VehicleRecord::line_stop_tick when the candidate has stopped. `line_m`: waiting position at the stop line, along the
// connection.
Wait stop_sign_wait(const Model& model, State& state, int lane, const Candidate& candidate, double line_m);

}  // namespace stopline
