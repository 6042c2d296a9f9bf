#include "sim/state/lane_blocks.h"

#include <algorithm>

#include "base/containers/index.h"
#include "base/simd/simd.h"

// A block is the range of slots of one lane in the vehicle arrays. The blocks are in the order in which lanes are
// processed, so that memory is read sequentially.
//
// Full dynamics: a block has room for a full lane and never moves. The kernels write whole batches of slots, also
// beyond the last vehicle. The slots there must therefore not belong to another lane.
//
// Mesoscale mode: a block has room for the present vehicles and a few more. A full block takes free slots from a block
// nearby. If no block nearby has free slots, all blocks are laid out again, which is rare.
namespace stopline {

namespace {

int rounded_up(int n) { return (n + kSimdWidth - 1) / kSimdWidth * kSimdWidth; }

// Returns the number of vehicles that fit on the lane bumper to bumper, plus a reserve of two.
int max_vehicles(const Model& model, const Lane& lane) {
    return static_cast<int>(lane.length_m / shortest_vehicle_m(model)) + 2;
}

// Full dynamics: the start of a block is aligned to a cache line, so the first vehicle of a lane is best placed there.
// When the first vehicle leaves the lane and at most kMaxShifted vehicles remain, the remaining vehicles are shifted to
// the start. A larger number of vehicles is shifted only when the vehicles have reached the end of the block.
constexpr int kMaxShifted = 64;

// Moves the vehicles of a block to the start of the block.
void shift_to_begin(State& state, LaneBlock& block) {
    if (block.first == block.begin) return;
    state.vehicles.move(block.first, block.count, block.begin);
    block.first = block.begin;
}

// Mesoscale mode: returns the size of a block for a number of vehicles, with a reserve for more.
int capacity_for(int vehicles) { return vehicles + 1 + vehicles / 16; }

// Returns the number of free slots before the block of a lane. One slot is for the sentinel: a copy of the first
// vehicle's leader, which is on a lane downstream. Before the first lane of a partition (a group of whole
// intersections) a whole batch of slots is free. The kernels of the previous partition may run in another thread, and
// the last batch that they write can reach beyond the last vehicle of that partition.
int slots_before(const Partition& part, int lane) { return lane == part.lanes.front() ? kSimdWidth : 1; }

// Lays out the blocks of all lanes again and wakes all lanes. `expected`: see reserve_blocks(). If `expected` is empty,
// the size of each block depends only on the number of its present vehicles.
void repack(State& state, const std::vector<int>& expected) {
    const auto capacity_of = [&](int lane) {
        return capacity_for(std::max(state.blocks[at(lane)].count, expected.empty() ? 0 : expected[at(lane)]));
    };
    LaneBlock& teleporting = state.congestion.teleporting;
    std::fill(state.queues.sleeps_until_green.begin(), state.queues.sleeps_until_green.end(), -1);
    int slots = kSimdWidth + capacity_for(teleporting.count);
    for (const Partition& part : state.partitions) {
        for (const int lane : part.lanes) slots += slots_before(part, lane) + capacity_of(lane);
    }
    slots += kSimdWidth;
    if (slots > state.vehicles.slots) state.vehicles.grow(slots + slots / 64);
    // First move all vehicles to the front of the arrays. Then distribute the blocks, from the last one to the first,
    // so that no block overwrites vehicles of another block.
    int next = kSimdWidth;
    const auto pack = [&](LaneBlock& block) {
        block.begin = next;
        shift_to_begin(state, block);
        next += block.count;
    };
    for (const int lane : state.plan.lane_order()) pack(state.blocks[at(lane)]);
    pack(teleporting);
    int end = slots - kSimdWidth;
    const auto spread = [&](LaneBlock& block, int size, int before) {
        block.end = end;
        block.begin = end - size;
        state.vehicles.move(block.first, block.count, block.begin);
        block.first = block.begin;
        end = block.begin - before;
    };
    spread(teleporting, capacity_for(teleporting.count), kSimdWidth);
    std::for_each(state.partitions.rbegin(), state.partitions.rend(), [&](const Partition& part) {
        std::for_each(part.lanes.rbegin(), part.lanes.rend(),
                      [&](int lane) { spread(state.blocks[at(lane)], capacity_of(lane), slots_before(part, lane)); });
    });
}

}  // namespace

double shortest_vehicle_m(const Model& model) {
    double shortest_m = 1e9;
    for (const PowertrainTables& type : model.vehicles) shortest_m = std::min(shortest_m, type.length_m);
    return std::min(shortest_m, model.demand.shortest_vehicle_m);
}

void allocate_lane_blocks(const Model& model, State& state) {
    const auto lanes = static_cast<int>(model.graph.lanes.size());
    state.blocks.resize(at(lanes));
    state.vehicles.has_several_types = model.vehicles.size() > 1;
    state.vehicles.has_itineraries = !model.demand.trips.empty() || !model.demand.path_routes.empty();
    state.vehicles.has_lane_changes = !state.plan.lanes_with_neighbours().empty();
    state.vehicles.has_human_drivers = model.has_human_drivers();
    state.vehicles.has_v2v_channel = model.v2v_plan.is_active;
    if (model.v2v_plan.is_active) state.vehicles.v2v.stored_messages = model.v2v_plan.stored_messages();
    const auto relays = [](const FollowingModel& following) { return following.relays_starts(); };
    state.vehicles.has_platoon_limit = model.meso && model.v2v_plan.max_platoon > 0 &&
                                       std::any_of(model.following.begin(), model.following.end(), relays);
    if (model.meso) {
        int slots = (2 + static_cast<int>(state.partitions.size())) * kSimdWidth + lanes;
        for (const Lane& lane : model.graph.lanes) slots += capacity_for(max_vehicles(model, lane));
        state.vehicles.reserve(slots);
        repack(state, {});
        return;
    }
    int slots = 0;
    const auto append = [&slots](LaneBlock& block, int vehicles) {
        block.begin = block.first = slots + kSimdWidth;
        block.end = slots = block.begin + vehicles;
    };
    for (const int lane : state.plan.lane_order()) {
        // The block has room for at least 50 % more vehicles than fit on the lane. The vehicles then rarely have to be
        // shifted to the start of the block.
        const int most = max_vehicles(model, model.graph.lanes[at(lane)]);
        append(state.blocks[at(lane)], rounded_up(most + std::max(most / 2, kSimdWidth)));
    }
    if (model.rules.teleport_ticks > 0 || !model.demand.trips.empty()) {
        append(state.congestion.teleporting, rounded_up(64 + lanes));
    }
    slots = rounded_up(slots) + kSimdWidth;  // the last batch of a block can reach beyond the block's end
    // With an active channel, senders store their messages (V2vReceivers::sent) instead of the samples of all steps.
    state.vehicles.resize(slots, model.radar.rows, model.v2v_plan.is_active ? 1 : model.v2v.rows);
}

void reserve_blocks(State& state, const std::vector<int>& expected) {
    if (!state.vehicles.has_powertrain()) repack(state, expected);
}

namespace {

constexpr int kMaxDistance = 8;  // the search for free slots covers this many lanes before and after a lane

// Shifts the block of a lane by `slots` slots, and moves its vehicles to the start of the shifted block. Wakes the
// lane.
void shift(State& state, int lane, int slots) {
    LaneBlock& block = state.blocks[at(lane)];
    state.vehicles.move(block.first, block.count, block.begin + slots);
    block.begin += slots;
    block.end += slots;
    block.first = block.begin;
    state.queues.sleeps_until_green[at(lane)] = -1;
}

// Enlarges the block of a lane by half of the free slots of the nearest lane that has any. Lanes of other partitions
// are not considered. Returns false if no lane within kMaxDistance has free slots.
bool take_from_neighbours(State& state, int lane) {
    const std::vector<int>& lanes = state.partition_of(lane).lanes;
    const auto own = state.location_of[at(lane)].index;
    const auto block = [&](int index) -> LaneBlock& { return state.blocks[at(lanes[at(index)])]; };
    const auto spare = [&](int index) {
        if (index < 0 || index >= static_cast<int>(lanes.size())) return 0;
        return (block(index).end - block(index).begin - block(index).count + 1) / 2;
    };
    for (int distance = 1; distance <= kMaxDistance; ++distance) {
        if (const int spared = spare(own + distance); spared > 0) {
            for (int index = own + distance; index > own; --index) shift(state, lanes[at(index)], spared);
            block(own + distance).end -= spared;
            block(own).end += spared;
            return true;
        }
        if (const int spared = spare(own - distance); spared > 0) {
            shift(state, lanes[at(own - distance)], 0);
            block(own - distance).end -= spared;
            for (int index = own - distance + 1; index <= own; ++index) shift(state, lanes[at(index)], -spared);
            block(own).end += spared;
            return true;
        }
    }
    return false;
}

// Returns true if the slot after the last vehicle is free. If the vehicles have reached the end of the block, first
// shifts them to the start of the block.
bool has_free_slot(State& state, LaneBlock& block) {
    if (block.past_last() == block.end) shift_to_begin(state, block);
    return block.past_last() < block.end;
}

}  // namespace

void ensure_free_slot(State& state, int lane) {
    state.queues.sleeps_until_green[at(lane)] = -1;
    if (has_free_slot(state, state.blocks[at(lane)]) || state.vehicles.has_powertrain()) return;
    if (!take_from_neighbours(state, lane)) repack(state, {});
}

void add_speed_target(State& state, Partition& part, int lane, const SpeedTarget& target) {
    part.speed_targets.add(lane, target, state.speed_targets_place);
    state.queues.standing[at(lane)].last_external_tick = static_cast<int>(state.tick);
}

void clear_speed_targets(State& state, Partition& part) { part.speed_targets.clear(state.speed_targets_place); }

void ensure_teleport_slot(State& state) {
    if (!has_free_slot(state, state.congestion.teleporting) && !state.vehicles.has_powertrain()) repack(state, {});
}

namespace {

// Mesoscale mode: sets those values of a vehicle that depend on its lane. The maximum speed of the vehicle does not
// count here, because the slot may not hold its vehicle yet. limit_to_maximum_speed() applies it later.
void set_lane_of(State& state, int lane, int slot) {
    VehicleArrays& v = state.vehicles;
    if (v.has_powertrain()) return;
    v.limit_mps[at(slot)] = state.plan.free_speed_mps(lane);
    v.next_limit_m[at(slot)] = state.plan.lane(lane).next_limit_m;
    v.speed_cap_mps[at(slot)] = kUnlimitedSpeed_mps;
}

// Marks a lane that receives a vehicle: adds it to the bitset Partition::occupied_candidates. Adds an exit lane also to
// the bitset Partition::exit_candidates.
void mark_occupied(State& state, int lane) {
    const LaneLocation& location = state.location_of[at(lane)];
    state.partitions[at(location.partition)].occupied_candidates.set(at(location.index));
    if (location.exit_partition >= 0) {
        state.partitions[at(location.exit_partition)].exit_candidates.set(at(location.exit_index));
    }
}

// Wakes a lane and dissolves its standing queue (QueueState). Must be called after the order of the vehicles on the
// lane has changed.
void wake(State& state, int lane) {
    state.queues.sleeps_until_green[at(lane)] = -1;
    state.queues.standing[at(lane)] = {0, 0, static_cast<int>(state.tick)};
}

}  // namespace

void limit_to_maximum_speed(State& state, int lane, int slot) {
    VehicleArrays& v = state.vehicles;
    if (!v.has_powertrain()) v.limit_mps[at(slot)] = state.plan.free_speed_mps(lane, v.policy[at(slot)]);
}

int append_slot(State& state, int lane) {
    for (const int detector : state.detectors.on_lane.of(lane)) ++state.detectors.upstream[at(detector)];
    LaneBlock& block = state.blocks[at(lane)];
    if (block.count == 0) shift_to_begin(state, block);
    ensure_free_slot(state, lane);
    mark_occupied(state, lane);
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
    for (const int detector : state.detectors.on_lane.of(lane)) {
        if (front_m >= model.detectors[at(detector)].position_m) --state.detectors.upstream[at(detector)];
    }
    return slot;
}

int move_to_lane(const Model& model, State& state, int lane, int from, int other, int index, double front_m) {
    ensure_free_slot(state, other);
    VehicleArrays& v = state.vehicles;
    LaneBlock& source = state.blocks[at(lane)];
    LaneBlock& target = state.blocks[at(other)];
    const int old = source.first + from;
    const int slot = target.first + index;
    v.move(slot, target.count - index, slot + 1);
    ++target.count;
    mark_occupied(state, other);
    v.copy(old, slot);
    set_lane_of(state, other, slot);
    limit_to_maximum_speed(state, other, slot);
    v.move(old + 1, source.count - from - 1, old);
    --source.count;
    if (!v.has_powertrain()) v.clear_slot(source.past_last());
    for (const int detector : state.detectors.on_lane.of(lane)) {
        if (v.position_m[at(slot)] < model.detectors[at(detector)].position_m) --state.detectors.upstream[at(detector)];
    }
    v.position_m[at(slot)] = front_m;
    for (const int detector : state.detectors.on_lane.of(other)) {
        if (front_m < model.detectors[at(detector)].position_m) ++state.detectors.upstream[at(detector)];
    }
    wake(state, lane);
    wake(state, other);
    return slot;
}

void remove_first(State& state, int lane) {
    LaneBlock& block = state.blocks[at(lane)];
    if (!state.vehicles.has_powertrain()) state.vehicles.clear_slot(block.first);
    ++block.first;
    --block.count;
    state.queues.sleeps_until_green[at(lane)] = -1;
    StandingQueue& queue = state.queues.standing[at(lane)];
    queue.first = std::max(queue.first - 1, 0);
    queue.end = std::max(queue.end - 1, 0);
    queue.released = std::max(queue.released - 1, 0);
    if (state.vehicles.has_powertrain() && block.count <= kMaxShifted) shift_to_begin(state, block);
}

}  // namespace stopline
