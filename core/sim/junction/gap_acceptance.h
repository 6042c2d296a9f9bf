// Gap acceptance: decides whether a vehicle that must yield may enter a conflict area before the next vehicle with
// priority, and finds vehicles that have accepted a gap and can no longer stop.
#pragma once

#include "sim/junction/candidate.h"
#include "sim/state/model.h"
#include "sim/state/partition.h"
#include "sim/state/state.h"

namespace stopline {

// The vehicle to which a candidate must yield.
struct GapBlocker {
    int slot = -1;  // -1: none
    YieldReason reason = YieldReason::priority;
};

// Returns the vehicle to which `candidate` on connection `lane` must yield. This is a vehicle with priority that
// arrives too soon. If the candidate is stopped and the network is imported, it can also be a vehicle without priority
// that has accepted a gap. Stores in VehicleRecord::accepted_gap_on whether the candidate accepts its gap. `wait_m`:
// the candidate's waiting position, along the connection. `delay_s`: the candidate can start only after this time.
GapBlocker find_gap_blocker(const Model& model, State& state, Partition& part, int lane, const Candidate& candidate,
                            double wait_m, double delay_s);

// Returns the slot of a vehicle without priority that approaches connection `conflict.other`, has accepted a gap, and
// can no longer stop comfortably before the first conflict area of this connection; -1: none. By now the accepted gap
// may be too short, because a stopped vehicle with priority may have started since.
int committed_vehicle(const Model& model, const State& state, const Conflict& conflict);

// Returns true if the committed vehicle in slot `other` will still be in the conflict area when `candidate`, which
// has priority, can arrive at the earliest. This can happen if the committed vehicle is later or slower than was
// predicted when it accepted its gap.
bool occupies_area_on_arrival(const Model& model, const State& state, int lane, const Conflict& conflict,
                              const Candidate& candidate, int other);

}  // namespace stopline
