// Detection of overlapping vehicles on a lane.
#pragma once

#include <cstdint>
#include <span>

#include "sim/state/state.h"

namespace stopline {

// Returns the number of vehicles on some lanes whose front is beyond the rear of their leader on the same lane.
std::int64_t count_overlaps(const VehicleArrays& vehicles, std::span<const LaneStep> lanes);

// Records the first overlap of a partition. Call it only if there is one, since it searches all vehicles.
void record_first_overlap(const Model& model, const State& state, Partition& part);

}  // namespace stopline
