// Imported networks: lets vehicles brake before a short approach lane. Right of way at an intersection is decided for
// the vehicles on its approach lanes. The lane between two close intersections can be shorter than the braking distance
// of a vehicle. A vehicle that learns only there that it must wait cannot stop before the conflict area.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Adds yield stops for vehicles that will drive over a short approach lane. As long as a vehicle is upstream of this
// lane, it must be able to stop before the first of these places:
//   - the stop line, if the signal is not green or there is a stop sign
//   - a conflict area where the vehicle must yield, or where another vehicle is
// The places are never upstream of the approach lane. So the vehicle reaches the lane, and right of way is decided
// there. Another thread can be deciding about that intersection. The function therefore reads only positions, speeds
// and signals, not decisions.
void stop_before_short_approaches(const Model& model, State& state, Partition& part);

}  // namespace stopline
