// Vehicles that pass the end of their lane: to the next one of their route, or out of the network.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "sim/phases.h"

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

// The lane does not serve the vehicle's way, and it could not change in time: it is put back behind the intersection, or stops at once.
void stray(const Model& model, State& state, int lane) {
    ++state.strayed;
    if (take_out(model, state, lane)) return;
    const std::size_t slot = at(state.blocks[at(lane)].first);
    state.vehicles.position_m[slot] = std::nextafter(state.plan.lane(lane).length_m, 0.0);
    state.vehicles.speed_mps[slot] = 0.0;
}

// Moves the first vehicle of a lane on along its route, or out of the network.
void pass_on(const Model& model, State& state, int lane) {
    VehicleArrays& v = state.vehicles;
    const double length_m = state.plan.lane(lane).length_m;
    const int next = v.next_lane[at(state.blocks[at(lane)].first)];
    const bool leaves = next < 0;
    const VehicleRecord& record = v.record[at(state.blocks[at(lane)].first)];
    if (leaves && record.trip >= 0 && !trip_ends(state, state.blocks[at(lane)].first)) return stray(model, state, lane);
    if (!leaves) make_room(state, next);
    const int slot = state.blocks[at(lane)].first;
    const int index = v.record[at(slot)].route_index + 1;
    const double line_m = leaves && record.trip >= 0 ? state.plan.lane(lane).stop_line_m : length_m;
    const double time_s = passing_time_s(model, state, slot, line_m);
    if (model.records_all) note_passage(state, time_s, slot, lane, next);
    if (const int approach = model.graph.lanes[at(lane)].approach; approach >= 0 && !leaves) {
        ++state.turned[at(approach)][static_cast<std::size_t>(model.graph.lanes[at(next)].turn)];
    }
    if (leaves) {
        ++state.left;
        if (v.record[at(slot)].trip >= 0) note_trip(state, model.trips_end, slot, time_s);
    } else {
        const int target = append_slot(state, next);
        v.copy(slot, target);
        v.position_m[at(target)] -= length_m;
        v.record[at(target)].came_by = v.record[at(target)].came_from;
        v.record[at(target)].came_from = lane;
        put_on_route(state, target, index);
        choose_way_on(model, state, next, target);
    }
    remove_first(state, lane);
}

}  // namespace

void note_passage(State& state, double time_s, int slot, int from, int to) {
    const VehicleArrays& v = state.vehicles;
    state.passages.push_back(
        {time_s, v.id[at(slot)], v.policy[at(slot)], from, to, static_cast<float>(v.speed_mps[at(slot)])});
}

// When the front passed `line_m` within the last step, from the mean speed of the step (mesoscale mode: all at the new speed).
double passing_time_s(const Model& model, const State& state, int slot, double line_m) {
    const VehicleArrays& v = state.vehicles;
    const double speed_mps = v.speed_mps[at(slot)];
    const double speed_before = model.meso ? speed_mps : speed_mps - v.acceleration_mps2[at(slot)] * model.step_s;
    const double mean_mps = std::max(0.5 * (speed_before + speed_mps), 1e-6);
    const double since_s = (v.position_m[at(slot)] - line_m) / mean_mps;
    return model.time_s(state.tick + 1) - std::clamp(since_s, 0.0, model.step_s);
}

void transfer_vehicles(const Model& model, State& state) {
    for (NetworkPart& part : state.parts) {
        for (const int lane : part.ended) {
            const LaneBlock& block = state.blocks[at(lane)];
            while (block.count > 0 && has_ended(state, lane, block.first)) pass_on(model, state, lane);
        }
    }
}

}  // namespace stopline
