// Merges the reports of the partitions into the records of the run.
#pragma once

#include "sim/state/state.h"

namespace stopline {

// Moves the reports of all partitions into the records, in the order of partitions.
void merge_partition_reports(State& state);

// Counts lost vehicles in all lanes.
void count_lost_vehicles(State& state);

}  // namespace stopline
