// Positions of rears, and net gaps between vehicles on one lane.
#pragma once

#include <concepts>

#include "base/containers/index.h"
#include "sim/state/vehicles/vehicle_arrays.h"

namespace stopline {

// Returns the position of the rear of a vehicle, m from the start of its lane. It is negative while the rear is still
// on a previous lane.
inline double rear_m(const VehicleArrays& v, std::integral auto slot) {
    return v.position_m[at(slot)] - static_cast<double>(v.length_m[at(slot)]);
}

// Returns the net gap from the front of the vehicle in `slot` to the rear of the vehicle in `leader_slot`, m. Both must
// have their positions on the same lane. For the first vehicle of a lane, `leader_slot` can be the sentinel slot.
inline double net_gap_m(const VehicleArrays& v, std::integral auto leader_slot, std::integral auto slot) {
    return rear_m(v, leader_slot) - v.position_m[at(slot)];
}

}  // namespace stopline
