// Records the vehicles whose front passes a detector. Works on one partition, a group of whole intersections.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Records each vehicle that has passed a detector of the partition in this step, if the run records this detector
// (Model::records_all). Also counts the vehicles that have passed a stop line on red.
void record_detector_crossings(const Model& model, State& state, Partition& part);

// Records the detectors that a vehicle has passed in this step on a lane that it has just reached. `slot`: slot of the
// vehicle, the last one of the lane. Call this function after the reports of the partitions have been merged.
void record_crossings_on_arrival(const Model& model, State& state, int lane, int slot);

}  // namespace stopline
