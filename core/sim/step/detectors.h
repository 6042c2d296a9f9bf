// Records the vehicles whose front passes a detector. Works on one partition, a group of whole intersections.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Records all crossings of this step on the lanes of a partition, and counts entries on red.
void record_detector_crossings(const Model& model, State& state, Partition& part);

}  // namespace stopline
