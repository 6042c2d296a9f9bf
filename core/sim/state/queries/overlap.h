// Detects vehicles that overlap their leader.
#pragma once

#include <cstdint>
#include <span>

#include "sim/state/state.h"

namespace stopline {

// Counts the vehicles on the given lanes that overlap their leader: the front of the vehicle is downstream of the rear
// of its leader. Leaders on other lanes are not considered.
std::int64_t count_overlaps(const VehicleArrays& vehicles, std::span<const LaneStep> lanes);

// Searches all vehicles of a partition for overlaps, and stores the first one in Violations::first unless an earlier
// violation is stored there. The search is slow, so call it only after count_overlaps() or a kernel has found an
// overlap.
void record_first_overlap(const Model& model, const State& state, Partition& part);

}  // namespace stopline
