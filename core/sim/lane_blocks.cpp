// Where the vehicles of each lane are in memory.
//
// Full dynamics: blocks that hold a full lane, since kernels write whole batches, beyond a lane's last vehicle. Mesoscale mode: blocks
// that hold what is there now and a little more, side by side in the order in which lanes are worked on, so that memory is read from
// end to end. When one of them is full, a neighbour gives it room; where none has any, all are laid out anew, which is rare.
#include <algorithm>

#include "sim/phases.h"

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

int rounded_up(int n) { return (n + kSimdWidth - 1) / kSimdWidth * kSimdWidth; }

// Room for all vehicles that fit on the lane bumper to bumper.
int most_vehicles(const Model& model, const Lane& lane) {
    return static_cast<int>(lane.length_m / shortest_vehicle_m(model)) + 2;
}

// At the start of its block a lane's share of an array begins with a line of the cache. Where few vehicles would have to move for
// that, they do whenever one leaves; where there are many, when the block's end is reached.
constexpr int kMovedUp = 64;

void move_up(State& state, LaneBlock& block) {
    if (block.first == block.begin) return;
    state.vehicles.move(block.first, block.count, block.begin);
    block.first = block.begin;
}

int some_more(int vehicles) { return vehicles + 2 + vehicles / 4; }

// Slots left free before a lane's block: kernels read beyond the last vehicle of the lane before, which may be another thread's.
int free_before(const NetworkPart& part, int lane) { return lane == part.lanes.front() ? kSimdWidth : 1; }

// `expected`: vehicles that each lane is about to get; empty: none in particular. Sleeping lanes know slots: they wake up.
void lay_out_anew(State& state, const std::vector<int>& expected) {
    const auto holds = [&](int lane) {
        return some_more(std::max(state.blocks[at(lane)].count, expected.empty() ? 0 : expected[at(lane)]));
    };
    std::fill(state.sleeps_until_green_of.begin(), state.sleeps_until_green_of.end(), -1);
    int slots = kSimdWidth + some_more(state.limbo.count);
    for (const NetworkPart& part : state.parts) {
        for (const int lane : part.lanes) slots += free_before(part, lane) + holds(lane);
    }
    slots += kSimdWidth;
    if (slots > state.vehicles.slots) state.vehicles.grow(slots + slots / 4);
    // All to the front, then, the last ones first, to their places.
    int next = kSimdWidth;
    const auto pack = [&](LaneBlock& block) {
        block.begin = next;
        move_up(state, block);
        next += block.count;
    };
    for (const int lane : state.plan.order()) pack(state.blocks[at(lane)]);
    pack(state.limbo);
    int end = slots - kSimdWidth;
    const auto spread = [&](LaneBlock& block, int size, int before) {
        block.end = end;
        block.begin = end - size;
        state.vehicles.move(block.first, block.count, block.begin);
        block.first = block.begin;
        end = block.begin - before;
    };
    spread(state.limbo, some_more(state.limbo.count), kSimdWidth);
    std::for_each(state.parts.rbegin(), state.parts.rend(), [&](const NetworkPart& part) {
        std::for_each(part.lanes.rbegin(), part.lanes.rend(),
                      [&](int lane) { spread(state.blocks[at(lane)], holds(lane), free_before(part, lane)); });
    });
}

}  // namespace

double shortest_vehicle_m(const Model& model) {
    double shortest_m = 1e9;
    for (const PowertrainTables& type : model.vehicles) shortest_m = std::min(shortest_m, type.length_m);
    return std::min(shortest_m, model.demand.shortest_trip_m);
}

void lay_out_blocks(const Model& model, State& state) {
    const auto lanes = static_cast<int>(model.graph.lanes.size());
    state.blocks.resize(at(lanes));
    if (model.meso) {
        int most = (2 + static_cast<int>(state.parts.size())) * kSimdWidth + lanes;
        for (const Lane& lane : model.graph.lanes) most += some_more(most_vehicles(model, lane));
        state.vehicles.reserve(most);
        lay_out_anew(state, {});
        return;
    }
    int slots = 0;
    const auto place = [&slots](LaneBlock& block, int vehicles) {
        block.begin = block.first = slots + kSimdWidth;
        block.end = slots = block.begin + vehicles;
    };
    for (const int lane : state.plan.order()) {
        // Half as many more, so that moving up is rare.
        const int most = most_vehicles(model, model.graph.lanes[at(lane)]);
        place(state.blocks[at(lane)], rounded_up(most + std::max(most / 2, kSimdWidth)));
    }
    if (model.rules.teleport_ticks > 0 || !model.demand.trips.empty()) place(state.limbo, rounded_up(64 + lanes));
    slots = rounded_up(slots) + kSimdWidth;  // the last batch of a lane reaches beyond its block
    state.vehicles.resize(slots, model.radar.rows, model.v2v.rows);
}

void expect_vehicles(State& state, const std::vector<int>& expected) {
    if (!state.vehicles.has_powertrain()) lay_out_anew(state, expected);
}

namespace {

constexpr int kNear = 8;  // lanes

// A lane's block goes on by so many slots, with its vehicles. Sleeping lanes know slots: it wakes up.
void shift(State& state, int lane, int by) {
    LaneBlock& block = state.blocks[at(lane)];
    state.vehicles.move(block.first, block.count, block.begin + by);
    block.begin += by;
    block.end += by;
    block.first = block.begin;
    state.sleeps_until_green_of[at(lane)] = -1;
}

// Takes half of what the nearest lane of the same part has to spare; false: none that is near has anything.
bool take_from_neighbours(State& state, int lane) {
    const ListedLane& listed = state.listed[at(lane)];
    const std::vector<int>& lanes = state.parts[listed.part].lanes;
    const auto own = static_cast<int>(listed.place);
    const auto block = [&](int place) -> LaneBlock& { return state.blocks[at(lanes[at(place)])]; };
    const auto spare = [&](int place) {
        if (place < 0 || place >= static_cast<int>(lanes.size())) return 0;
        return (block(place).end - block(place).begin - block(place).count + 1) / 2;
    };
    for (int distance = 1; distance <= kNear; ++distance) {
        if (const int spared = spare(own + distance); spared > 0) {
            for (int place = own + distance; place > own; --place) shift(state, lanes[at(place)], spared);
            block(own + distance).end -= spared;
            block(own).end += spared;
            return true;
        }
        if (const int spared = spare(own - distance); spared > 0) {
            shift(state, lanes[at(own - distance)], 0);
            block(own - distance).end -= spared;
            for (int place = own - distance + 1; place <= own; ++place) shift(state, lanes[at(place)], -spared);
            block(own).end += spared;
            return true;
        }
    }
    return false;
}

// Whether there is a free slot behind the last vehicle, if need be after moving up.
bool has_room(State& state, LaneBlock& block) {
    if (block.stop() == block.end) move_up(state, block);
    return block.stop() < block.end;
}

}  // namespace

void make_room(State& state, int lane) {
    state.sleeps_until_green_of[at(lane)] = -1;
    if (has_room(state, state.blocks[at(lane)]) || state.vehicles.has_powertrain()) return;
    if (!take_from_neighbours(state, lane)) lay_out_anew(state, {});
}

void make_room_in_limbo(State& state) {
    if (!has_room(state, state.limbo) && !state.vehicles.has_powertrain()) lay_out_anew(state, {});
}

namespace {

// What a lane asks of the vehicle in a slot.
void set_lane_of(State& state, int lane, int slot) {
    VehicleArrays& v = state.vehicles;
    if (v.has_powertrain()) return;
    v.limit_mps[at(slot)] = state.plan.driven_mps(lane);
    v.turn_m[at(slot)] = state.plan.lane(lane).turn_m;
    v.imposed_mps[at(slot)] = kAnySpeed_mps;
}

// Somebody comes to a lane.
void mark(State& state, int lane) {
    const ListedLane& listed = state.listed[at(lane)];
    state.parts[listed.part].may_be_occupied.set(listed.place);
    if (listed.exits_of >= 0) state.parts[at(listed.exits_of)].may_reach_back.set(listed.exit);
}

// Vehicles of a lane have come or gone within it.
void wake(State& state, int lane) {
    state.sleeps_until_green_of[at(lane)] = -1;
    state.resting[at(lane)] = {0, 0, state.tick};
}

}  // namespace

int append_slot(State& state, int lane) {
    for (const int detector : state.detectors_of[at(lane)]) ++state.upstream[at(detector)];
    LaneBlock& block = state.blocks[at(lane)];
    if (block.count == 0) move_up(state, block);
    make_room(state, lane);
    mark(state, lane);
    const int slot = block.first + block.count++;
    set_lane_of(state, lane, slot);
    return slot;
}

int insert_slot(const Model& model, State& state, int lane, double front_m) {
    const int last = append_slot(state, lane);
    const LaneBlock& block = state.blocks[at(lane)];
    VehicleArrays& v = state.vehicles;
    int slot = last;
    while (slot > block.first && v.position_m[at(slot - 1)] < front_m) --slot;
    if (slot < last) {
        v.move(slot, last - slot, slot + 1);
        set_lane_of(state, lane, slot);
        wake(state, lane);
    }
    for (const int detector : state.detectors_of[at(lane)]) {
        if (front_m >= model.detectors[at(detector)].position_m) --state.upstream[at(detector)];
    }
    return slot;
}

int put_beside(const Model& model, State& state, int lane, int from, int other, int place, double front_m) {
    make_room(state, other);
    VehicleArrays& v = state.vehicles;
    LaneBlock& source = state.blocks[at(lane)];
    LaneBlock& target = state.blocks[at(other)];
    const int old = source.first + from;
    const int slot = target.first + place;
    v.move(slot, target.count - place, slot + 1);
    ++target.count;
    mark(state, other);
    v.copy(old, slot);
    set_lane_of(state, other, slot);
    v.move(old + 1, source.count - from - 1, old);
    --source.count;
    if (!v.has_powertrain()) v.forget(source.stop());
    for (const int detector : state.detectors_of[at(lane)]) {
        if (v.position_m[at(slot)] < model.detectors[at(detector)].position_m) --state.upstream[at(detector)];
    }
    v.position_m[at(slot)] = front_m;
    for (const int detector : state.detectors_of[at(other)]) {
        if (front_m < model.detectors[at(detector)].position_m) ++state.upstream[at(detector)];
    }
    wake(state, lane);
    wake(state, other);
    return slot;
}

void remove_first(State& state, int lane) {
    LaneBlock& block = state.blocks[at(lane)];
    if (!state.vehicles.has_powertrain()) state.vehicles.forget(block.first);
    ++block.first;
    --block.count;
    state.sleeps_until_green_of[at(lane)] = -1;
    Resting& resting = state.resting[at(lane)];
    resting.from = std::max(resting.from - 1, 0);
    resting.to = std::max(resting.to - 1, 0);
    resting.told = std::max(resting.told - 1, 0);
    if (state.vehicles.has_powertrain() && block.count <= kMovedUp) move_up(state, block);
}

}  // namespace stopline
