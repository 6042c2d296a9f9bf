// Resets the sensors of a new vehicle, or of a vehicle with a new leader.
#pragma once

#include "sim/state/vehicles/vehicle_arrays.h"

namespace stopline {

// Makes the vehicle in the preceding slot the leader of the vehicle in `slot`. The vehicle in `slot` is then no platoon
// leader, and its radar history is reset. For the first vehicle of the lane, only removes the old leader. Does nothing
// if `slot` is past the last vehicle of the lane's block.
void reset_leader(VehicleArrays& vehicles, int slot, const LaneBlock& block);

// Initialises the leader and the radar and V2V data of a vehicle just inserted. `first`: the vehicle is the first of
// its lane.
void initialise_sensors(VehicleArrays& vehicles, int slot, bool first);

}  // namespace stopline
