#include "sim/performance/prefetch.h"

#include <algorithm>
#include <cstdint>

#include "base/containers/index.h"
#include "base/simd/simd.h"

namespace stopline {

namespace {

constexpr std::uintptr_t kCacheLine = 64;  // bytes
constexpr std::size_t kLinesPerCall = 4;   // cache lines prefetched per call; the processor would ignore further ones
constexpr int kInspectedVehicles = 7;      // number of vehicles near the stop line that a step usually reads

// These functions must be inlined, because the compiler removes calls of functions that only prefetch.
template <class Array>
STOPLINE_INLINE void prefetch(const Array& array, int index) {
    __builtin_prefetch(&array[at(index)]);
}

STOPLINE_INLINE void prefetch_vehicle(const VehicleArrays& v, int slot) {
    prefetch(v.position_m, slot);
    prefetch(v.speed_mps, slot);
    prefetch(v.length_m, slot);
    prefetch(v.acceleration_mps2, slot);
    prefetch(v.id, slot);
}

// Prefetches the last vehicle of a lane. Also prefetches the first vehicle and the vehicles that the decisions at the
// stop line read, unless the lane sleeps. A lane sleeps while its first vehicle rests before a red signal, and there
// are no decisions at its stop line in this time.
STOPLINE_INLINE void prefetch_lane_ends(const State& state, int lane) {
    const VehicleArrays& v = state.vehicles;
    const LaneBlock& block = state.blocks[at(lane)];
    if (block.count == 0) return;
    const bool awake = state.queues.sleeps_until_green[at(lane)] < 0;
    if (awake) prefetch(v.record, block.first);
    prefetch_vehicle(v, block.last());
    prefetch(v.standstill_gap_m, block.last());
    if (!awake) return;
    if (block.count > kInspectedVehicles) {
        prefetch(v.position_m, block.first + kInspectedVehicles);
        prefetch(v.next_lane, block.first + kInspectedVehicles);
        prefetch(v.standstill_gap_m, block.first);
    }
    prefetch_vehicle(v, block.first);
    prefetch(v.is_platoon_leader, block.first);
    prefetch(v.speed_cap_mps, block.first);
    prefetch(v.next_lane, block.first);
}

class CacheLines {
public:
    template <class T>
    void add(const T* begin, const T* end) {
        const char* const stop = reinterpret_cast<const char*>(end);
        const char* line = reinterpret_cast<const char*>(begin);
        for (line -= reinterpret_cast<std::uintptr_t>(line) % kCacheLine; line < stop; line += kCacheLine) {
            lines_.push_back(line);
        }
    }
    // Returns each cache line once, in ascending order of addresses.
    std::vector<const char*> sorted() {
        std::sort(lines_.begin(), lines_.end());
        lines_.erase(std::unique(lines_.begin(), lines_.end()), lines_.end());
        return lines_;
    }

private:
    std::vector<const char*> lines_;
};

}  // namespace

void list_cache_lines(const Model& model, State& state, Partition& part) {
    CacheLines lines;
    const auto add = [&](const auto* begin, const auto* end) { lines.add(begin, end); };
    const auto element = [&](const auto& array, int index) {
        lines.add(array.data() + index, array.data() + index + 1);
    };
    for (const int lane : part.lanes) {
        state.plan.for_each_memory_range(lane, add);
        element(state.blocks, lane), element(state.queues.sleeps_until_green, lane);
        element(state.queues.standing, lane), element(state.junctions.yield_stops_index, lane);
        if (state.plan.lane(lane).signal_group >= 0) {
            element(state.stop_lines.lines, lane), element(state.stop_lines.stop_slot, lane);
            element(state.stop_lines.held_at_green, lane);
        }
    }
    const JunctionState& junctions = state.junctions;
    for (const int lane : part.connections) {
        element(junctions.occupants_place, lane), element(junctions.approaching_place, lane);
        for (const Bitset* set : {&junctions.occupied, &junctions.with_stopped, &junctions.to_decide}) {
            const std::uint64_t* const word = set->word_of(at(state.plan.lane(lane).bitset_index));
            add(word, word + 1);
        }
    }
    for (const int exit : part.exits) {
        element(state.blocks, exit), element(state.stop_lines.exit_rooms, exit);
        const std::span<const int> connections = model.connections_to.of(exit);
        add(connections.data(), connections.data() + connections.size());
    }
    part.cache_lines = lines.sorted();
}

void begin_prefetch(State& state, std::size_t number, std::size_t end) {
    PrefetchProgress& progress = state.partitions[number].prefetch;
    progress = {};
    // With fewer than kMinVehicles vehicles, all data stay in the third-level cache, and prefetching would cost more
    // than it saves.
    constexpr int kMinVehicles = 30000;
    if (state.present() < kMinVehicles) return;
    if (number + 1 < end) progress.next = &state.partitions[number + 1];
    if (number + 2 < end) progress.second = &state.partitions[number + 2];
}

void advance_prefetch_step(const State& state, PrefetchProgress& progress) {
    if (progress.second != nullptr) {
        const std::vector<const char*>& lines = progress.second->cache_lines;
        const std::size_t end = std::min(lines.size(), progress.line + kLinesPerCall);
        for (; progress.line < end; ++progress.line) __builtin_prefetch(lines[progress.line]);
    }
    const Partition& next = *progress.next;
    const std::size_t k = progress.lane++;
    // next.occupied still lists the lanes that held vehicles in the previous step, because the decisions for the
    // partition `next` have not begun.
    const IndexBuffer& occupied = next.occupied;
    if (k < occupied.size()) {
        prefetch_lane_ends(state, occupied[k]);
    } else if (k - occupied.size() < next.exits.size()) {
        const LaneBlock& block = state.blocks[at(next.exits[k - occupied.size()])];
        if (block.count == 0) return;
        prefetch_vehicle(state.vehicles, block.last());
        prefetch(state.vehicles.standstill_gap_m, block.last());
    }
}

}  // namespace stopline
