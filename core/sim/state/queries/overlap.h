// Detects vehicles that overlap their leader on the same lane.
#pragma once

#include <cstdint>
#include <span>

#include "sim/state/state.h"

namespace stopline {

// Returns the number of vehicles on the given lanes whose front is downstream of their leader's rear. Leaders on other
// lanes are not considered.
std::int64_t count_overlaps(const VehicleArrays& vehicles, std::span<const LaneStep> lanes);

// Searches all vehicles of a partition and records the first overlap. The search is slow, so call it only after
// count_overlaps() or a kernel has found an overlap.
void record_first_overlap(const Model& model, const State& state, Partition& part);

}  // namespace stopline
