// Cooperative gap opening: a vehicle that must change lanes asks by V2V for a gap, and one vehicle of the target lane
// opens it.
#pragma once

#include "sim/lane_change/lane_change.h"
#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Prepares cooperative gap opening. Call before the first step.
void init_gap_cooperation(const Model& model, State& state);

// Adds and removes the requests of a partition, finds openers, and adapts the speeds of requesters and openers.
void cooperate_on_gaps(const Model& model, State& state, Partition& part);

// Returns true if the vehicle in `slot` of `lane` is a requester that knows of its agreement.
bool has_gap_agreement(const State& state, int lane, int slot);

// Returns true if the vehicle in `slot` of `lane` holds open a gap for a vehicle other than `requester` (id).
bool is_reserved(const State& state, int lane, int slot, int requester);

}  // namespace stopline
