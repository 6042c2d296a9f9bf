// Merges the events and counters that each partition has recorded in a step (its report) into the records of the run. A
// partition is a group of whole intersections.
#pragma once

#include "sim/state/state.h"

namespace stopline {

// Moves the reports of all partitions into the records of the run, and updates the number of lost vehicles
// (Violations::lost_vehicles).
void merge_partition_reports(State& state);

// Counts the vehicles on all lanes and the vehicles that are being teleported, and updates the number of lost vehicles.
void count_lost_vehicles(State& state);

}  // namespace stopline
