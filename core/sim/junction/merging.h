// Vehicles on different connections that merge into one exit lane. Such a vehicle follows the one ahead of it in the
// order of distances to the exit lane, as if that vehicle were on its own lane. Imported networks only.
#pragma once

#include "sim/junction/candidate.h"
#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Returns true if vehicles on the two connections of a conflict follow each other into the same exit lane.
bool is_merge(const Model& model, const State& state, int lane, const Conflict& conflict);

// Returns the net gap in m from candidate `v` on connection `lane` to the rear of a vehicle on connection `other` with
// its front at `other_front_m`. The gap is the difference of the distances to the exit lane. It is negative if the
// vehicles are side by side, or if the other vehicle is further away.
double merging_gap_m(const State& state, int lane, const Candidate& v, int other, int other_slot, double other_front_m);

// Returns true if candidate `v` on connection `lane` goes before a vehicle on connection `conflict.other` with its
// front at `other_front_m`, because of their positions: if only the candidate is in the conflict area, if both are in
// it and the candidate is nearer to the exit lane, or if the candidate is wholly ahead.
bool merges_first(const State& state, int lane, const Candidate& v, const Conflict& conflict, int other_slot,
                  double other_front_m);

// Returns where candidate `v` must be able to stop in order to follow the vehicle in `other_slot`, m along its
// connection. Both are assumed to brake equally, so the position moves on with the other vehicle. Until the candidate
// is in the conflict area, the position is not upstream of the waiting position before the area, and it stays there
// while the vehicles are side by side.
double merging_stop_m(const Model& model, const State& state, int lane, const Candidate& v, const Conflict& conflict,
                      int other_slot, double other_front_m);

// Zipper: returns how candidate `v` must follow the vehicle of the other connection that is ahead of it in the order of
// distances to the exit lane. No wait: there is no such vehicle.
Wait zipper_wait(const Model& model, const State& state, int lane, const Candidate& v, const Conflict& conflict);

}  // namespace stopline
