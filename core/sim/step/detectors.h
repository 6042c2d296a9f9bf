// Records the fronts that pass detectors.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Records the crossings of this step on the lanes of a partition, and entries on red.
void record_detector_crossings(const Model& model, State& state, Partition& part);

}  // namespace stopline
