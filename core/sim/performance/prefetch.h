// Prefetches the data of the next partitions while the present one is decided. The processor cannot foresee which data
// a lane leads to.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Lists the cache lines that each step reads of a partition. Call once after make_state().
void list_cache_lines(const Model& model, State& state, Partition& part);

// Starts the prefetching for the partitions after `number`, up to `end`. Does nothing if the data fit into the cache.
void begin_prefetch(State& state, std::size_t number, std::size_t end);

void advance_prefetch_step(const State& state, PrefetchProgress& progress);

// Prefetches a few cache lines. Phases call it once a lane.
inline void advance_prefetch(const State& state, PrefetchProgress& progress) {
    if (progress.next != nullptr) advance_prefetch_step(state, progress);
}

}  // namespace stopline
