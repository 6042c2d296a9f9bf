// Imported networks: lets vehicles brake before a short approach lane. Right of way at an intersection is decided for
// the vehicles on its approach lanes. The lane between two close intersections can be shorter than the braking distance
// of a vehicle. If the decision came only on this lane, the vehicle could no longer stop before the conflict area.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Adds a yield stop for each vehicle whose decision distance reaches beyond the end of its lane to one of these places.
// The vehicle must be able to stop before the first of them:
//   - the stop line, if there is a stop sign, or if the signal is not green and the vehicle can still stop there
//   - a conflict area where the vehicle must yield, or that another vehicle occupies
// The places are never upstream of the approach lane. So the vehicle reaches the lane, and right of way is decided
// there. Another thread can be deciding about that intersection. The function therefore reads only positions, speeds
// and signals, not decisions.
void stop_before_short_approaches(const Model& model, State& state, Partition& part);

}  // namespace stopline
