// Loads the data of the next partitions into the cache while decisions are made for the present partition. A partition
// is a group of whole intersections. The processor cannot predict the addresses, because the data of a lane are in many
// places.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Sets Partition::cache_lines, the list of the cache lines that every step reads for the partition. Call this function
// once after make_state().
void list_cache_lines(const Model& model, State& state, Partition& part);

// Starts the prefetching of the two partitions after partition `number`. Partitions from `end` on are not prefetched,
// because they belong to another thread. Starts no prefetching if the data of all vehicles fit into the cache.
void begin_prefetch(State& state, std::size_t number, std::size_t end);

// Prefetches a few cache lines. begin_prefetch() must have started the prefetching.
void advance_prefetch_step(const State& state, PrefetchProgress& progress);

// Prefetches a few cache lines if begin_prefetch() has started the prefetching. Several phases of a step call this
// function once for each lane that they process.
inline void advance_prefetch(const State& state, PrefetchProgress& progress) {
    if (progress.next != nullptr) advance_prefetch_step(state, progress);
}

}  // namespace stopline
