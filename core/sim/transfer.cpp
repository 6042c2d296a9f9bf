// Vehicles that change lanes along their route, enter and leave.
#include <algorithm>

#include "sim/phases.h"

namespace stopline {

namespace {

constexpr float kNoLowerLimit_mps = 1e3F;

std::size_t at(int index) { return static_cast<std::size_t>(index); }

// Limit that the vehicle's route sets at the end of the lane it is on.
float end_speed(const Model& model, const Route& route, int index) {
    if (at(index) + 1 >= route.lanes.size()) return kNoLowerLimit_mps;
    const double here = model.graph.lanes[at(route.lanes[at(index)])].limit_mps;
    const double next = model.graph.lanes[at(route.lanes[at(index) + 1])].limit_mps;
    return next < here ? static_cast<float>(next) : kNoLowerLimit_mps;
}

void note(State& state, double time_s, int slot, int from, int to) {
    const VehicleArrays& v = state.vehicles;
    state.passages.push_back(
        {time_s, v.id[at(slot)], v.policy[at(slot)], from, to, static_cast<float>(v.speed_mps[at(slot)])});
}

// Moves the first vehicle of a lane on along its route, or out of the network.
void pass_on(const Model& model, State& state, int lane) {
    VehicleArrays& v = state.vehicles;
    const int slot = state.blocks[at(lane)].first;
    const double length_m = model.graph.lanes[at(lane)].length_m;
    const double time_s = passing_time_s(model, state, slot, length_m);
    const Route& route = model.graph.routes[at(v.route[at(slot)])];
    const int index = v.route_index[at(slot)] + 1;
    const bool leaves = at(index) >= route.lanes.size();
    const int next = leaves ? -1 : route.lanes[at(index)];
    note(state, time_s, slot, lane, next);
    if (leaves) {
        ++state.left;
    } else {
        const int target = append_slot(state, next);
        v.copy(slot, target);
        v.position_m[at(target)] -= length_m;
        v.route_index[at(target)] = index;
        v.end_speed_mps[at(target)] = end_speed(model, route, index);
    }
    LaneBlock& block = state.blocks[at(lane)];
    ++block.first;
    --block.count;
}

// The speed and place at which a vehicle can enter; false when there is no room yet.
bool room_to_enter(const Model& model, const State& state, int lane, const CompiledPolicy& policy, double& speed_mps) {
    const LaneBlock& block = state.blocks[at(lane)];
    if (block.count == 0) return true;
    const VehicleArrays& v = state.vehicles;
    const std::size_t last = at(block.last());
    const double gap_m = v.position_m[last] - v.length_m[last];
    speed_mps = std::min(speed_mps, v.speed_mps[last]);
    double desired_m = 0.0;
    double slope_s = 0.0;
    policy.law->evaluate(policy.settings, {&speed_mps, 1}, {&desired_m, 1}, {&slope_s, 1});
    return gap_m >= desired_m + speed_mps * model.demand.entry_headway_s * 0.5;
}

void enter(const Model& model, State& state, int inlet_index, double speed_mps) {
    const DemandPlan::Inlet& inlet = model.demand.inlets[at(inlet_index)];
    InletState& entered = state.inlets[at(inlet_index)];
    const int policy = entered.next_policy;
    const int route = entered.next_route;
    entered.next_policy = -1;
    const int slot = append_slot(state, inlet.lane);
    VehicleArrays& v = state.vehicles;
    const std::size_t i = at(slot);
    const PowertrainTables& type = model.vehicles[0];
    v.position_m[i] = 0.0;
    v.speed_mps[i] = speed_mps;
    v.acceleration_mps2[i] = v.request_mps2[i] = v.torque_Nm[i] = v.brake_N[i] = 0.0F;
    v.gear_time_s[i] = static_cast<float>(type.minimum_gear_time_s);
    v.lag_s[i] = static_cast<float>(type.lag_unloaded_s[0]);
    v.length_m[i] = static_cast<float>(type.length_m);
    v.gear[i] = static_cast<float>(gear_for(type, speed_mps));
    v.leads[i] = 1.0F;
    v.standstill_gap_m[i] = static_cast<float>(model.policies[at(policy)].settings.standstill_gap_m);
    v.end_speed_mps[i] = end_speed(model, model.graph.routes[at(route)], 0);
    v.policy[i] = policy;
    v.type[i] = 0;
    v.id[i] = state.next_id++;
    v.route[i] = route;
    v.route_index[i] = 0;
    v.cleared_for[i] = -1;
    v.inside_since[i] = 0;
    const bool first = state.blocks[at(inlet.lane)].count == 1;
    v.predecessor[i] = first ? -1 : v.id[i - 1];
    const double gap_m = first ? 1e6 : v.position_m[i - 1] - v.length_m[i - 1];
    v.reset_radar(slot, gap_m, first ? 0.0 : speed_mps - v.speed_mps[i - 1]);
    v.reset_v2v(slot);
    ++entered.entered;
    entered.last_entry_s = model.time_s(state.tick + 1);
    ++state.entered;
    note(state, entered.last_entry_s, slot, -1, inlet.lane);
}

}  // namespace

// When the front passed `line_m` within the last step, from the mean speed of the step.
double passing_time_s(const Model& model, const State& state, int slot, double line_m) {
    const VehicleArrays& v = state.vehicles;
    const double speed_before = v.speed_mps[at(slot)] - v.acceleration_mps2[at(slot)] * model.step_s;
    const double mean_mps = std::max(0.5 * (speed_before + v.speed_mps[at(slot)]), 1e-6);
    const double since_s = (v.position_m[at(slot)] - line_m) / mean_mps;
    return model.time_s(state.tick + 1) - std::clamp(since_s, 0.0, model.step_s);
}

int append_slot(State& state, int lane) {
    for (const int detector : state.detectors_of[at(lane)]) ++state.upstream[at(detector)];
    LaneBlock& block = state.blocks[at(lane)];
    if (block.stop() == block.end) {
        for (int k = 0; k < block.count; ++k) state.vehicles.copy(block.first + k, block.begin + k);
        block.first = block.begin;
    }
    return block.first + block.count++;
}

void transfer_vehicles(const Model& model, State& state) {
    for (const int lane : state.occupied) {
        const double length_m = model.graph.lanes[at(lane)].length_m;
        const LaneBlock& block = state.blocks[at(lane)];
        while (block.count > 0 && state.vehicles.position_m[at(block.first)] >= length_m) pass_on(model, state, lane);
    }
}

void insert_vehicles(const Model& model, State& state) {
    for (int k = 0; k < static_cast<int>(model.demand.inlets.size()); ++k) {
        const DemandPlan::Inlet& inlet = model.demand.inlets[at(k)];
        InletState& entered = state.inlets[at(k)];
        if (entered.entered >= inlet.vehicles) continue;
        if (entered.next_policy < 0) {
            entered.next_policy = model.demand.policy_of(k, entered.entered);
            entered.next_route = model.demand.route_of(k, entered.entered);
        }
        if (model.time_s(state.tick + 1) - entered.last_entry_s < model.demand.entry_headway_s) continue;
        double speed_mps = std::min(model.demand.entry_speed_mps, model.graph.lanes[at(inlet.lane)].limit_mps);
        const CompiledPolicy& policy = model.policies[at(entered.next_policy)];
        if (room_to_enter(model, state, inlet.lane, policy, speed_mps)) enter(model, state, k, speed_mps);
    }
}

}  // namespace stopline
