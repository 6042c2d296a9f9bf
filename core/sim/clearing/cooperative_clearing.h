// Cooperative clearing: vehicles with V2V announce where they will come to rest, and a vehicle enters an intersection
// only if there is room for it beyond the conflict area (driver/traffic_rules.h).
//
//   - The vehicles of a lane announce together which of them will leave the lane in the present green, and where the
//     first one that remains will rest. From this the vehicles upstream know the room on the lane (exit_booking.h).
//   - A vehicle that is admitted books a place on its exit lane. It enters without further conditions, so the vehicles
//     upstream of it can rely on it. A vehicle is admitted when it must decide whether to stop. It is admitted earlier
//     if all vehicles ahead are admitted and it will reach the line in the present green.
//   - A vehicle that is refused stops at the line and becomes a platoon leader.
//   - Turning vehicles that wait at a red signal claim places on their exit lane. Otherwise the straight traffic of the
//     other street would fill it, and a refused vehicle would hold up all vehicles behind it.
//   - Vehicles without V2V, and vehicles whose announcements are not fresh, obey the keep-clear rule.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Prepares the state for a model with cooperative clearing. Does nothing if the rule is off.
void init_clearing(const Model& model, State& state);

// Determines the claims of turning vehicles for the exit lanes of a partition, at intervals.
void update_claims(const Model& model, State& state, Partition& part);

// Decides which vehicles of a lane with a stop line are admitted to the intersection, and makes their announcement.
// Returns the slot of the first vehicle that must stop at the line because it is refused; -1: none. Stores the reason
// in StopLines::held_at_green. `stopping_slot`: slot of the vehicle that stops for its signal; -1: none.
int admit_vehicles(const Model& model, State& state, int lane, int stopping_slot);

}  // namespace stopline
