#include "sim/step/transfer.h"

#include <cmath>
#include <utility>
#include <vector>

#include "base/containers/index.h"
#include "sim/congestion/teleport.h"
#include "sim/lane_change/route_choice.h"
#include "sim/state/lane_blocks.h"
#include "sim/state/queries/lane_end.h"
#include "sim/state/queries/passage.h"
#include "sim/step/detectors.h"

namespace stopline {

namespace {

// Handles a missed turn: the lane's first vehicle has reached the end of the lane, but no connection of the lane makes
// the next turn of its trip. Teleports the vehicle past the intersection. If teleporting is impossible, stops the
// vehicle at the end of the lane.
void miss_turn(const Model& model, State& state, int lane) {
    ++state.congestion.missed_turns;
    if (remove_for_teleport(model, state, lane)) return;
    const std::size_t slot = at(state.blocks[at(lane)].first);
    state.vehicles.position_m[slot] = std::nextafter(state.plan.lane(lane).length_m, 0.0);
    state.vehicles.speed_mps[slot] = 0.0;
}

// Moves the first vehicle of a lane to the next lane of its route, or out of the network. Calls miss_turn() instead if
// the vehicle has no next lane although its trip does not end here. Adds the next lane to `passed` if the vehicle is
// already beyond its end.
void transfer_first(const Model& model, State& state, int lane, std::vector<int>& passed) {
    VehicleArrays& v = state.vehicles;
    const double length_m = state.plan.lane(lane).length_m;
    const int first = state.blocks[at(lane)].first;
    const int next = v.next_lane[at(first)];
    const bool leaves = next < 0;
    if (leaves && v.itinerary_of(at(first)).has_trip() && !is_on_last_edge(state, first))
        return miss_turn(model, state, lane);
    if (!leaves) ensure_free_slot(state, next);
    const int slot = state.blocks[at(lane)].first;  // ensure_free_slot() can shift the vehicle to another slot
    const bool has_trip = v.itinerary_of(at(slot)).has_trip();
    const int route_index = v.record[at(slot)].route_index + 1;
    const double line_m = leaves && has_trip ? state.plan.lane(lane).stop_line_m : length_m;
    const double time_s = passing_time_s(model, state, slot, line_m);
    if (model.records_all) record_passage(state.records, v, time_s, slot, lane, next);
    if (const int approach = model.graph.lanes[at(lane)].approach; approach >= 0 && !leaves) {
        ++state.records.turned[at(approach)][static_cast<std::size_t>(model.graph.lanes[at(next)].turn)];
    }
    if (leaves) {
        ++state.records.exited;
        if (has_trip) record_trip_crossing(state.records, v, time_s, slot, model.trips_end);
    } else {
        const int target = append_slot(state, next);
        v.copy(slot, target);
        limit_to_maximum_speed(state, next, target);
        v.position_m[at(target)] -= length_m;
        v.record[at(target)].second_previous_lane = v.record[at(target)].previous_lane;
        v.record[at(target)].previous_lane = lane;
        set_route_index(model, state, target, route_index);
        choose_next_route(model, state, next, target);
        record_crossings_on_arrival(model, state, next, target);
        if (has_left_lane(state, next, target)) passed.push_back(next);
    }
    remove_first(state, lane);
}

}  // namespace

// A vehicle can drive over several short lanes in one step. Each round moves the vehicles by one lane.
void transfer_vehicles(const Model& model, State& state) {
    std::vector<int> passed;  // lanes whose last vehicle is beyond the end of the lane
    const auto transfer_from = [&](const std::vector<int>& lanes) {
        for (const int lane : lanes) {
            const LaneBlock& block = state.blocks[at(lane)];
            while (block.count > 0 && has_left_lane(state, lane, block.first))
                transfer_first(model, state, lane, passed);
        }
    };
    for (const Partition& part : state.partitions) transfer_from(part.lanes_to_transfer);
    while (!passed.empty()) transfer_from(std::exchange(passed, {}));
}

}  // namespace stopline
