// Sensor history of a new vehicle, and of a vehicle with a new leader.
#pragma once

#include "sim/state/vehicles/vehicle_arrays.h"

namespace stopline {

// Resets the radar history after the leader has changed. Does nothing if `slot` is past the last vehicle of the block.
void reset_leader(VehicleArrays& vehicles, int slot, const LaneBlock& block);

// Initialises leader, radar and V2V of a vehicle just inserted. `first`: the vehicle is the first of its lane.
void initialise_sensors(VehicleArrays& vehicles, int slot, bool first);

}  // namespace stopline
