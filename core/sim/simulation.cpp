#include "sim/simulation.h"

#include "base/state_hash.h"
#include "sim/meso_dynamics.h"
#include "sim/phases.h"

namespace stopline {

namespace {

// About 150 bytes of each vehicle are read and written in a step; a second-level cache holds 1 MiB or more.
constexpr int kVehiclesInCache = 4000;

}  // namespace

Simulation::Simulation(const Model& model) : model_(model), tables_(full_tables(model)), state_(make_state(model)) {
    check(model);
    form_queues(model_, state_);
}

void Simulation::step() {
    state_.radar = rows_at(model_.radar, state_.tick, state_.vehicles.slots);
    state_.v2v = rows_at(model_.v2v, state_.tick, state_.vehicles.slots);
    read_signals(model_, state_);
    find_occupied_lanes(model_, state_);
    decide_stops(model_, state_);
    give_way(model_, state_);
    look_beyond_lanes(model_, state_);
    move_vehicles();
    watch_detectors(model_, state_);
    transfer_vehicles(model_, state_);
    insert_vehicles(model_, state_);
    verify(state_);
    ++state_.tick;
}

// Lanes go through the kernels in groups that fit into the first-level cache.
void Simulation::move_vehicles() {
    std::vector<LaneStep>& lanes = state_.lane_steps;
    const bool prefetch = state_.present() > kVehiclesInCache;
    int vehicles = 0;
    lanes.clear();
    for (std::size_t k = 0; k < state_.occupied.size(); ++k) {
        LaneStep lane = lane_step(model_, state_, state_.occupied[k]);
        const bool last = k + 1 == state_.occupied.size();
        if (prefetch && !last) {
            lane.to_next_lane = state_.blocks[static_cast<std::size_t>(state_.occupied[k + 1])].first - lane.begin;
        }
        lanes.push_back(lane);
        vehicles += lane.stop - lane.begin;
        if (vehicles < State::kVehiclesTogether && !last) continue;
        if (model_.meso) {
            step_meso(model_, lanes, state_);
        } else {
            step_full(model_, tables_, lanes, state_);
        }
        state_.updates += vehicles;
        vehicles = 0;
        lanes.clear();
    }
}

void Simulation::run_until(double time_s) {
    const std::int64_t last = to_ticks(time_s, model_.step_s);
    while (state_.tick < last) step();
}

std::uint64_t Simulation::state_hash() const {
    StateHash hash;
    const VehicleArrays& v = state_.vehicles;
    for (const LaneBlock& block : state_.blocks) {
        for (int slot = block.first; slot < block.stop(); ++slot) {
            const auto i = static_cast<std::size_t>(slot);
            hash.add(v.id[i]);
            hash.add(v.gear[i]);
            hash.add(v.leads[i]);
            hash.add(v.position_m[i]);
            hash.add(v.speed_mps[i]);
            for (const float value : {v.acceleration_mps2[i], v.request_mps2[i], v.torque_Nm[i], v.brake_N[i],
                                      v.gear_time_s[i], v.lag_s[i]}) {
                hash.add(value);
            }
        }
    }
    for (const Passage& passage : state_.passages) {
        hash.add(passage.time_s);
        hash.add(passage.vehicle);
    }
    hash.add(state_.tick);
    hash.add(state_.entered);
    hash.add(state_.left);
    return hash.value();
}

}  // namespace stopline
