// Merges the reports of the partitions into the records of the run. A partition is a group of whole intersections.
#pragma once

#include "sim/state/state.h"

namespace stopline {

// Moves the reports of all partitions into the records of the run, in the order of the partitions.
void merge_partition_reports(State& state);

// Counts the vehicles on all lanes, and updates the number of lost vehicles (Violations::lost_vehicles).
void count_lost_vehicles(State& state);

}  // namespace stopline
