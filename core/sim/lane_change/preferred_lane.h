// Chooses the lane of an approach that suits the turns after the next intersection.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// The lane changes that a vehicle needs downstream of the next intersection if it leaves the approach from some lane.
// A drawn route is known up to the third intersection ahead, a trip up to its end.
struct LaterChanges {
    int at_second = 0;  // before the second intersection ahead; for a trip: on all later edges
    int in_total = 0;   // before the second and the third intersection ahead; for a trip: on all later edges
};
// Returns the lane changes that remain if the vehicle in `slot` takes its next turn from `lane`. Returns kNoTurn for
// both numbers if `lane` does not allow the turn.
LaterChanges later_changes(const Model& model, const State& state, int lane, int slot);
inline constexpr int kNoTurn = 100;

// Sets the preferred lane of a vehicle (LaneChangeMemory::preferred_offset). From that lane it needs the fewest lane
// changes later. Among equally good lanes the nearest one is preferred. All lanes from the current lane to the
// preferred lane allow the next turn. Must be called after each change of the vehicle's lane or of its known turns.
void update_preferred_lane(const Model& model, State& state, int lane, int slot);

}  // namespace stopline
