#include "sim/simulation.h"

#include "base/state_hash.h"
#include "sim/meso_dynamics.h"
#include "sim/phases.h"

namespace stopline {

Simulation::Simulation(const Model& model) : model_(model), tables_(full_tables(model)), state_(make_state(model)) {
    check(model);
    form_queues(model_, state_);
}

void Simulation::step() {
    state_.radar = rows_at(model_.radar, state_.tick, state_.vehicles.slots);
    state_.v2v = rows_at(model_.v2v, state_.tick, state_.vehicles.slots);
    read_signals(model_, state_);
    find_occupied_lanes(model_, state_);
    find_insiders(model_, state_);
    decide_stops(model_, state_);
    give_way(model_, state_);
    look_beyond_lanes(model_, state_);
    watch_hindrance(model_, state_);
    move_vehicles();
    watch_detectors(model_, state_);
    transfer_vehicles(model_, state_);
    insert_vehicles(model_, state_);
    move_blocked_on(model_, state_);
    verify(state_);
    ++state_.tick;
}

// Lanes go through the kernels in groups that fit into the first-level cache.
void Simulation::move_vehicles() {
    std::vector<LaneStep>& lanes = state_.lane_steps;
    lanes.clear();
    for (const int lane : state_.occupied) lanes.push_back(lane_step(model_, state_, lane));
    const auto group_from = [&lanes](std::size_t first) {
        std::size_t stop = first;
        for (int vehicles = 0; stop < lanes.size() && vehicles < State::kVehiclesTogether; ++stop) {
            vehicles += lanes[stop].count();
        }
        return std::span<const LaneStep>(lanes.data() + first, stop - first);
    };
    std::span<const LaneStep> group = group_from(0);
    for (std::size_t done = 0; !group.empty();) {
        done += group.size();
        const std::span<const LaneStep> next = group_from(done);
        for (const LaneStep& lane : group) state_.updates += lane.count();
        if (model_.meso) {
            step_meso(model_, group, state_);
        } else {
            step_full(model_, tables_, group, state_.outgrows_cache() ? next : next.first(0), state_);
        }
        group = next;
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
