#include "sim/step/simulation.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>

#include <fmt/format.h>

#include "base/containers/index.h"
#include "base/state_hash.h"
#include "signals/external.h"
#include "sim/clearing/cooperative_clearing.h"
#include "sim/congestion/delay_causes.h"
#include "sim/congestion/teleport.h"
#include "sim/congestion/wait_reasons.h"
#include "sim/full_dynamics/full_dynamics.h"
#include "sim/full_dynamics/receive_messages.h"
#include "sim/insertion/insert_vehicles.h"
#include "sim/insertion/trips.h"
#include "sim/junction/lights/phase_priority.h"
#include "sim/junction/lights/signals.h"
#include "sim/junction/occupants.h"
#include "sim/junction/right_of_way.h"
#include "sim/junction/stop_lines.h"
#include "sim/lane_change/gap_cooperation.h"
#include "sim/lane_change/gap_search.h"
#include "sim/lane_change/lane_change.h"
#include "sim/mesoscale/meso_blocks.h"
#include "sim/perception/look_ahead.h"
#include "sim/performance/prefetch.h"
#include "sim/speed_advice/speed_advice.h"
#include "sim/state/events.h"
#include "sim/state/lane_blocks.h"
#include "sim/step/detectors.h"
#include "sim/step/move_vehicles.h"
#include "sim/step/occupied_lanes.h"
#include "sim/step/partition_reports.h"
#include "sim/step/transfer.h"

namespace stopline {

namespace {

State checked_state(const Model& model, int threads) {
    check(model);
    return make_state(model, threads);
}

// One thread processes the partitions [begin, end).
struct Share {
    std::size_t begin;
    std::size_t end;
};

Share share_of(std::size_t parts, int thread, int threads) {
    if (threads == 1) return {0, parts};
    const auto from = [&](int k) { return parts * static_cast<std::size_t>(k) / static_cast<std::size_t>(threads); };
    return {from(thread), from(thread + 1)};
}

}  // namespace

Simulation::Simulation(const Model& model, int threads)
    : model_(model),
      tables_(full_tables(model)),
      state_(checked_state(model, threads)),
      threads_(std::min(threads, static_cast<int>(state_.partitions.size()))) {
    if (model_.meso) {
        for (Partition& part : state_.partitions) list_cache_lines(model_, state_, part);
    }
    init_clearing(model_, state_);
    init_gap_cooperation(model_, state_);
    insert_initial_queues(model_, state_);
    start_signals(model_, state_);
}

void Simulation::request_acceleration(int vehicle, double acceleration_mps2) {
    if (model_.meso)
        throw std::invalid_argument(
            "vehicles of the mesoscale mode have no requested acceleration; use fidelity: full");
    if (vehicle < 0 || vehicle >= state_.insertion.next_id)
        throw std::invalid_argument(fmt::format("vehicle {} has not entered the network", vehicle));
    state_.external_requests.set(vehicle, acceleration_mps2);
}

bool Simulation::set_policy(int vehicle, int policy) {
    if (policy < 0 || at(policy) >= model_.policies.size())
        throw std::invalid_argument(fmt::format("policy {} does not exist; the population has the policies 0 to {}",
                                                policy, model_.policies.size() - 1));
    VehicleArrays& v = state_.vehicles;
    for (const LaneBlock& block : state_.blocks) {
        for (int slot = block.first; slot < block.past_last(); ++slot) {
            if (v.id[at(slot)] != vehicle) continue;
            const VehicleClass& present = model_.classes[at(v.policy[at(slot)])];
            const VehicleClass& wanted = model_.classes[at(policy)];
            if (present.vehicle != wanted.vehicle || present.driver != wanted.driver)
                throw std::invalid_argument("the policy belongs to another vehicle type or driver");
            v.policy[at(slot)] = policy;
            v.standstill_gap_m[at(slot)] = static_cast<float>(model_.policies[at(policy)].settings.standstill_gap_m);
            return true;
        }
    }
    return false;
}

void Simulation::request_phase(std::size_t signal, int phase) {
    if (signal >= model_.signals.size())
        throw std::invalid_argument(
            fmt::format("signal {} does not exist; the network has {}", signal, model_.signals.size()));
    stopline::request_phase(model_.signals[signal], signal, phase, state_.signals);
}

void Simulation::decide(int thread, int threads) {
    const Share share = share_of(state_.partitions.size(), thread, threads);
    for (std::size_t k = share.begin; k < share.end; ++k) {
        if (model_.meso) begin_prefetch(state_, k, share.end);
        decide(state_.partitions[k]);
    }
}

void Simulation::decide(Partition& part) {
    find_occupied_lanes(state_, state_.queues, part);
    find_leaders_beyond_lanes(model_, state_, state_.vehicles, part);
    find_junction_occupants(state_, state_.junctions, part);
    decide_stop_lines(model_, state_, part);
    decide_right_of_way(model_, state_, part);
    clear_speed_targets(state_, part);
    prepare_lane_changes(model_, state_, part);
    if (model_.has_speed_advice) advise_speeds(model_, state_, part);
    if (model_.meso) collect_moving_blocks(model_, state_, part);
}

// Moves the vehicles of the last partition first, because the data of the last partitions are still in the cache after
// decide(). After move() the data of the first partitions are in the cache, and decide() of the next step begins with
// the first partition.
void Simulation::move(int thread, int threads) {
    const Share share = share_of(state_.partitions.size(), thread, threads);
    for (std::size_t k = share.end; k-- > share.begin;) move(state_.partitions[k]);
}

void Simulation::move(Partition& part) {
    part.updates += part.present;
    move_vehicles(model_, tables_, state_, part);
    record_detector_crossings(model_, state_, part);
}

// Finds the stopped vehicles and the causes of their delay, as watch_delays() does, but divides the partitions among
// the threads. All threads of an OpenMP team must call this function.
void Simulation::watch_delays_in_parallel() {
    const auto for_each_partition = [&](int thread, auto visit) {
        const Share share = share_of(state_.partitions.size(), thread, threads_);
        for (std::size_t k = share.begin; k < share.end; ++k) visit(state_.partitions[k]);
    };
#pragma omp single
    prepare_delay_watch(model_, state_.congestion.watch);
#pragma omp for schedule(static, 1)
    for (int thread = 0; thread < threads_; ++thread) {
        for_each_partition(thread, [&](Partition& part) { find_stopped_vehicles(model_, state_, part); });
    }
#pragma omp for schedule(static, 1)
    for (int thread = 0; thread < threads_; ++thread) {
        for_each_partition(thread,
                           [&](Partition& part) { find_wait_reasons(model_, state_, state_.congestion.watch, part); });
    }
#pragma omp single
    attribute_delays(model_, state_);
}

void Simulation::step() {
    if (threads_ == 1 || state_.present() < threads_from_vehicles_) return step(false);
    if (always_uses_threads_) return step(true);
    const int vehicles = state_.present();
    const auto begin = std::chrono::steady_clock::now();
    step(heuristic_.use_threads());
    heuristic_.record_step(std::chrono::steady_clock::now() - begin, vehicles);
}

void Simulation::step(bool use_threads) {
    state_.radar = delay_rows_at(model_.radar, state_.tick, state_.vehicles.slots);
    if (!state_.vehicles.has_v2v_channel) {
        state_.v2v = delay_rows_at(model_.v2v, state_.tick, state_.vehicles.slots);
    }
    update_phase_priorities(model_, state_);
    measure_density(model_, state_);
    if (!use_threads) {
        decide(0, 1);
        if (delay_watch_is_due(model_, state_)) watch_delays(model_, state_);
        move(0, 1);
    } else {
#pragma omp parallel num_threads(threads_)
        {
#pragma omp for schedule(static, 1)
            for (int thread = 0; thread < threads_; ++thread) decide(thread, threads_);
            if (delay_watch_is_due(model_, state_)) watch_delays_in_parallel();
#pragma omp for schedule(static, 1)
            for (int thread = 0; thread < threads_; ++thread) move(thread, threads_);
        }
    }
    merge_partition_reports(state_);
    transfer_vehicles(model_, state_);
    insert_vehicles(model_, state_);
    insert_trips(model_, state_);
    teleport_blocked_vehicles(model_, state_);
    change_lanes(model_, state_);
    ++state_.tick;
    update_signals(model_, state_);
}

void Simulation::run_until(double time_s) {
    const std::int64_t last = to_ticks(time_s, model_.step_s);
    while (state_.tick < last) step();
    count_lost_vehicles(state_);
}

std::uint64_t Simulation::state_hash() const {
    StateHash hash;
    const VehicleArrays& v = state_.vehicles;
    for (const LaneBlock& block : state_.blocks) {
        for (int slot = block.first; slot < block.past_last(); ++slot) {
            const auto i = static_cast<std::size_t>(slot);
            hash.add(v.id[i]);
            hash.add(v.is_platoon_leader[i]);
            hash.add(v.position_m[i]);
            hash.add(v.speed_mps[i]);
            hash.add(v.acceleration_mps2[i]);
            if (v.has_human_drivers) hash.add(v.start_ticks[i]);
            if (v.has_v2v_channel) {
                hash.add(v.v2v.sent_tick[i]);
                hash.add(v.v2v.mode[i]);
                hash.add(v.v2v.time_gap_s[i]);
            }
            if (v.has_platoon_limit) {
                hash.add(v.platoon.place[i]);
                hash.add(v.platoon.time_gap_s[i]);
            }
            if (model_.meso) continue;
            for (const float value :
                 {v.gear[i], v.request_mps2[i], v.torque_Nm[i], v.brake_N[i], v.gear_time_s[i], v.lag_s[i]}) {
                hash.add(value);
            }
        }
    }
    for (const Passage& passage : state_.records.passages) {
        hash.add(passage.time_s);
        hash.add(passage.vehicle);
    }
    add_signals(model_, state_, hash);
    hash.add(state_.tick);
    hash.add(state_.records.entered);
    hash.add(state_.records.exited);
    return hash.value();
}

}  // namespace stopline
