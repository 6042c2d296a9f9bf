// Tests whether a vehicle has reached the end of its lane or its trip.
#pragma once

#include "base/containers/index.h"
#include "sim/state/state.h"

namespace stopline {

// Returns true if the vehicle is on the last edge of its trip. It will be removed at the stop line and ignores the
// signal there.
inline bool is_on_last_edge(const State& state, int slot) {
    if (state.vehicles.next_lane[at(slot)] >= 0) return false;
    return state.vehicles.itinerary_of(at(slot)).has_trip() &&
           state.plan.turn_of(state.vehicles.record[at(slot)].route) == Turn::none;
}

// Returns true if the front of a vehicle has passed the end of its lane. On the last edge of a trip the stop line is
// the end.
inline bool has_left_lane(const State& state, int lane, int slot) {
    const LanePlan& plan = state.plan.lane(lane);
    const double position_m = state.vehicles.position_m[at(slot)];
    if (position_m >= plan.length_m) return true;
    if (plan.signal_group < 0 || position_m < plan.stop_line_m) return false;
    return is_on_last_edge(state, slot);
}

}  // namespace stopline
