// Finds the reason for which each stopped vehicle waits. Works on one partition, a group of whole intersections.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Lists the stopped vehicles of a partition as queues (Partition::stopped_queues). Sets
// VehicleArrays::stopped_since_tick of all moving vehicles of the partition to the present tick. Counts the vehicles
// that have stopped since the previous call (Partition::stops).
void find_stopped_vehicles(const Model& model, State& state, Partition& part);

// Finds the blocker of the first vehicle of each queue of a partition, and the cause that stops the vehicle itself
// (StoppedQueue::direct_cause). find_stopped_vehicles() must have run for all partitions before.
void find_wait_reasons(const Model& model, const State& state, DelayWatch& watch, Partition& part);

}  // namespace stopline
