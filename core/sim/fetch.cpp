// Brings into the cache what the next parts of the network need while the present one is decided: the processor does not see in time
// what a lane leads to.
#include <algorithm>
#include <cstdint>

#include "base/simd.h"
#include "sim/phases.h"

namespace stopline {

namespace {

constexpr std::uintptr_t kLine = 64;   // bytes
constexpr std::size_t kLinesEach = 4;  // more at once and the processor drops them
constexpr int kFew = 7;                // vehicles

std::size_t at(int index) { return static_cast<std::size_t>(index); }

// Inlined, all of these: the compiler leaves out calls of functions that do nothing but fetch.
template <class Array>
STOPLINE_INLINE void fetch(const Array& array, int index) {
    __builtin_prefetch(&array[at(index)]);
}

STOPLINE_INLINE void fetch_seen(const VehicleArrays& v, int slot) {
    fetch(v.position_m, slot);
    fetch(v.speed_mps, slot);
    fetch(v.length_m, slot);
    fetch(v.acceleration_mps2, slot);
    fetch(v.id, slot);
}

// The vehicles at the ends of a lane.
STOPLINE_INLINE void fetch_ends(const State& state, int lane) {
    const VehicleArrays& v = state.vehicles;
    const LaneBlock& block = state.blocks[at(lane)];
    if (block.count == 0) return;
    if (state.sleeps_until_green_of[at(lane)] < 0) fetch(v.record, block.first);
    fetch_seen(v, block.last());
    fetch(v.standstill_gap_m, block.last());
    if (state.sleeps_until_green_of[at(lane)] >= 0) return;
    if (block.count > kFew) {  // a queue: so far drivers near the stop line are looked at
        fetch(v.position_m, block.first + kFew);
        fetch(v.next_lane, block.first + kFew);
        fetch(v.standstill_gap_m, block.first);
    }
    fetch_seen(v, block.first);
    fetch(v.leads, block.first);
    fetch(v.imposed_mps, block.first);
    fetch(v.next_lane, block.first);
}

class Lines {
public:
    template <class T>
    void add(const T* begin, const T* end) {
        const char* const stop = reinterpret_cast<const char*>(end);
        const char* line = reinterpret_cast<const char*>(begin);
        for (line -= reinterpret_cast<std::uintptr_t>(line) % kLine; line < stop; line += kLine) all_.push_back(line);
    }
    std::vector<const char*> in_order() {
        std::sort(all_.begin(), all_.end());
        all_.erase(std::unique(all_.begin(), all_.end()), all_.end());
        return all_;
    }

private:
    std::vector<const char*> all_;
};

}  // namespace

void list_lines(const Model& model, State& state, NetworkPart& part) {
    Lines lines;
    const auto add = [&](const auto* begin, const auto* end) { lines.add(begin, end); };
    const auto one = [&](const auto& array, int index) { lines.add(array.data() + index, array.data() + index + 1); };
    for (const int lane : part.lanes) {
        state.plan.for_each_place(lane, add);
        one(state.blocks, lane), one(state.sleeps_until_green_of, lane), one(state.resting, lane);
        one(state.has_holds, lane);
        if (state.plan.lane(lane).signal_group >= 0) {
            one(state.stop_lines, lane), one(state.stop_slot, lane), one(state.kept_out, lane);
        }
    }
    for (const int lane : part.inside) {
        one(state.insiders, lane), one(state.coming, lane);
        for (const Marks* marks : {&state.with_insiders, &state.with_standing, &state.deciding}) {
            const std::uint64_t* const word = marks->word_of(at(state.plan.lane(lane).mark));
            add(word, word + 1);
        }
        add(state.insiders[at(lane)].data(), state.insiders[at(lane)].data() + 1);
    }
    for (const int exit : part.exits) {
        one(state.blocks, exit), one(state.exit_rooms, exit), one(model.leads_to, exit);
        const std::vector<int>& ways = model.leads_to[at(exit)];
        add(ways.data(), ways.data() + ways.size());
    }
    part.lines = lines.in_order();
}

void begin_to_fetch(State& state, std::size_t number, std::size_t end) {
    Fetching& fetching = state.parts[number].fetching;
    fetching = {};
    // Fewer vehicles, with their lanes, stay in a third-level cache: looking ahead would cost more than it saves.
    constexpr int kFromVehicles = 30000;
    if (state.present() < kFromVehicles) return;
    if (number + 1 < end) fetching.next = &state.parts[number + 1];
    if (number + 2 < end) fetching.second = &state.parts[number + 2];
}

void fetch_more(const State& state, Fetching& fetching) {
    if (fetching.second != nullptr) {
        const std::vector<const char*>& lines = fetching.second->lines;
        const std::size_t end = std::min(lines.size(), fetching.line + kLinesEach);
        for (; fetching.line < end; ++fetching.line) __builtin_prefetch(lines[fetching.line]);
    }
    const NetworkPart& next = *fetching.next;
    const std::size_t k = fetching.lane++;
    const NumberList& occupied = next.occupied;  // in the step before
    if (k < occupied.size()) {
        fetch_ends(state, occupied[k]);
    } else if (k - occupied.size() < next.exits.size()) {
        const LaneBlock& block = state.blocks[at(next.exits[k - occupied.size()])];
        if (block.count == 0) return;
        fetch_seen(state.vehicles, block.last());
        fetch(state.vehicles.standstill_gap_m, block.last());
    }
}

}  // namespace stopline
