// Merging of vehicles from different connections into one exit lane. The distances to the exit lane give the order of
// the vehicles, and each vehicle follows the one ahead of it in this order, as if all were on one lane. Imported
// networks only.
#pragma once

#include "sim/junction/candidate.h"
#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Returns true if connection `lane` and connection `conflict.other` lead to the same exit lane and the network is
// imported.
bool is_merge(const Model& model, const State& state, int lane, const Conflict& conflict);

// Returns true if the positions of two vehicles let `candidate` on connection `lane` go first. The other vehicle is
// on connection `conflict.other`, with its front at `other_front_m`. The candidate goes first in three cases: Only the
// candidate is in the conflict area. Both vehicles are in the area, and the candidate is nearer to the exit lane (at
// equal distances: has the lower id). Only the other vehicle is in the area, but the candidate is wholly ahead of it.
bool merges_first(const State& state, int lane, const Candidate& candidate, const Conflict& conflict, int other_slot,
                  double other_front_m);

// Returns the position, in m along the candidate's connection, where `candidate` must be able to stop in order to
// follow the vehicle in `other_slot`. The position is one standstill gap upstream of the place where the rear of that
// vehicle would come to rest if that vehicle braked now. For a candidate that has not entered the conflict area, the
// result is not upstream of its waiting position before the area. If the net gap is too short to enter the area, the
// result is this waiting position.
double merging_stop_m(const Model& model, const State& state, int lane, const Candidate& candidate,
                      const Conflict& conflict, int other_slot, double other_front_m);

// Zipper merging (Conflict::zipper): the vehicles of two connections merge in the order of their distances to the exit
// lane. Returns where `candidate` must be able to stop behind the vehicle of the other connection that is directly
// ahead of the candidate in this order; no wait if there is no such vehicle. A vehicle on the exit lane counts
// while its rear on the other connection leaves no room to enter the conflict area. If the candidate is in this area,
// such a vehicle always counts. Ignores vehicles that stop at their line or yield.
Wait zipper_wait(const Model& model, const State& state, int lane, const Candidate& candidate,
                 const Conflict& conflict);

}  // namespace stopline
