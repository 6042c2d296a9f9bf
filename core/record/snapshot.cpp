#include "record/snapshot.h"

#include <algorithm>

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

template <class From, class To>
void copy(const From& from, int slots, To& to) {
    to.assign(from.begin(), from.begin() + slots);
}

void copy_standing(const HindranceWatch& watch, std::vector<Snapshot::Standing>& standing) {
    standing.clear();
    for (const int slot : watch.standing) {
        const int ahead = watch.waits_for[at(slot)];
        standing.push_back(
            {slot, watch.vehicle[at(slot)], watch.cause[at(slot)], ahead < 0 ? -1 : watch.vehicle[at(ahead)]});
    }
}

}  // namespace

void Snapshot::take(const State& state, bool with_standing) {
    const VehicleArrays& v = state.vehicles;
    tick = state.tick;
    entered = state.entered;
    left = state.left;
    copy(v.id, v.slots, vehicle);
    copy(v.policy, v.slots, policy);
    copy(v.position_m, v.slots, position_m);
    copy(v.speed_mps, v.slots, speed_mps);
    copy(v.length_m, v.slots, length_m);
    next_lane.resize(at(v.slots));
    lanes.resize(state.blocks.size());
    for (std::size_t lane = 0; lane < lanes.size(); ++lane) {
        const LaneBlock& block = state.blocks[lane];
        lanes[lane] = {block.first, block.count};
        for (int slot = block.first; slot < block.stop(); ++slot) next_lane[at(slot)] = v.record[at(slot)].next_lane;
    }
    if (with_standing) copy_standing(state.watch, standing);
}

}  // namespace stopline
