// Finds the slot of a vehicle on a lane, and the lane of a vehicle.
#pragma once

#include "base/containers/index.h"
#include "sim/state/state.h"

namespace stopline {

// Returns the slot of the vehicle with this id on a lane; -1: none.
inline int slot_on_lane(const State& state, int lane, int id) {
    if (id < 0) return -1;
    const LaneBlock& block = state.blocks[at(lane)];
    for (int slot = block.first; slot < block.past_last(); ++slot) {
        if (state.vehicles.id[at(slot)] == id) return slot;
    }
    return -1;
}

// Does the same, but looks first where the vehicle is expected. `expected_index`: number of vehicles on the lane that
// were ahead of it in the previous step.
inline int slot_on_lane(const State& state, int lane, int id, int expected_index) {
    const LaneBlock& block = state.blocks[at(lane)];
    for (const int index : {expected_index, expected_index - 1, expected_index + 1}) {
        const int slot = block.first + index;
        if (block.has(slot) && state.vehicles.id[at(slot)] == id) return slot;
    }
    return slot_on_lane(state, lane, id);
}

// Returns the present lane of a vehicle on a route.
inline int lane_of(const State& state, int slot) {
    const VehicleRecord& record = state.vehicles.record[at(slot)];
    return state.plan.route(record.route)[at(record.route_index)];
}

}  // namespace stopline
