#include "sim/simulation.h"

#include <algorithm>
#include <chrono>

#include "base/state_hash.h"
#include "sim/phases.h"

namespace stopline {

namespace {

State checked_state(const Model& model, int threads) {
    check(model);
    return make_state(model, threads);
}

// The parts of one thread.
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
      threads_(std::min(threads, static_cast<int>(state_.parts.size()))) {
    form_queues(model_, state_);
}

void Simulation::decide(int thread, int threads) {
    const Share share = share_of(state_.parts.size(), thread, threads);
    for (std::size_t k = share.begin; k < share.end; ++k) {
        if (model_.meso) begin_to_fetch(state_, k, share.end);
        decide(state_.parts[k]);
    }
}

void Simulation::decide(NetworkPart& part) {
    find_occupied_lanes(state_, part);
    look_beyond_lanes(model_, state_, part);
    find_insiders(state_, part);
    decide_stops(model_, state_, part);
    give_way(model_, state_, part);
    wait_to_change(model_, state_, part);
    if (model_.meso) collect_moves(model_, state_, part);
}

// From the last part to the first: what was decided last, and what the next step begins with, is still in the cache.
void Simulation::move(int thread, int threads) {
    const Share share = share_of(state_.parts.size(), thread, threads);
    for (std::size_t k = share.end; k-- > share.begin;) move(state_.parts[k]);
}

void Simulation::move(NetworkPart& part) {
    part.updates += part.present;
    move_vehicles(model_, tables_, state_, part);
    watch_detectors(model_, state_, part);
}

// By all threads: watch_hindrance().
void Simulation::share_watch() {
    const auto each = [&](int thread, auto look) {
        const Share share = share_of(state_.parts.size(), thread, threads_);
        for (std::size_t k = share.begin; k < share.end; ++k) look(state_.parts[k]);
    };
#pragma omp single
    prepare_watch(model_, state_);
#pragma omp for schedule(static, 1)
    for (int thread = 0; thread < threads_; ++thread) {
        each(thread, [&](NetworkPart& part) { note_standing(state_, part); });
    }
#pragma omp for schedule(static, 1)
    for (int thread = 0; thread < threads_; ++thread) {
        each(thread, [&](const NetworkPart& part) { find_waits(model_, state_, part); });
    }
#pragma omp single
    attribute_hindrance(model_, state_);
}

void Simulation::step() {
    if (threads_ == 1 || state_.present() < share_from_) return step(false);
    if (shares_always_) return step(true);
    const int vehicles = state_.present();
    const auto begin = std::chrono::steady_clock::now();
    step(sharing_.shares());
    sharing_.made(std::chrono::steady_clock::now() - begin, vehicles);
}

void Simulation::step(bool shared) {
    state_.radar = rows_at(model_.radar, state_.tick, state_.vehicles.slots);
    state_.v2v = rows_at(model_.v2v, state_.tick, state_.vehicles.slots);
    read_signals(model_, state_);
    if (!shared) {
        decide(0, 1);
        if (looks_for_hindrance(model_, state_)) watch_hindrance(model_, state_);
        move(0, 1);
    } else {
#pragma omp parallel num_threads(threads_)
        {
#pragma omp for schedule(static, 1)
            for (int thread = 0; thread < threads_; ++thread) decide(thread, threads_);
            if (looks_for_hindrance(model_, state_)) share_watch();
#pragma omp for schedule(static, 1)
            for (int thread = 0; thread < threads_; ++thread) move(thread, threads_);
        }
    }
    gather_reports(state_);
    transfer_vehicles(model_, state_);
    insert_vehicles(model_, state_);
    insert_trips(model_, state_);
    move_blocked_on(model_, state_);
    change_lanes(model_, state_);
    ++state_.tick;
}

void Simulation::run_until(double time_s) {
    const std::int64_t last = to_ticks(time_s, model_.step_s);
    while (state_.tick < last) step();
    verify(state_);
}

std::uint64_t Simulation::state_hash() const {
    StateHash hash;
    const VehicleArrays& v = state_.vehicles;
    for (const LaneBlock& block : state_.blocks) {
        for (int slot = block.first; slot < block.stop(); ++slot) {
            const auto i = static_cast<std::size_t>(slot);
            hash.add(v.id[i]);
            hash.add(v.leads[i]);
            hash.add(v.position_m[i]);
            hash.add(v.speed_mps[i]);
            hash.add(v.acceleration_mps2[i]);
            if (model_.meso) continue;
            for (const float value :
                 {v.gear[i], v.request_mps2[i], v.torque_Nm[i], v.brake_N[i], v.gear_time_s[i], v.lag_s[i]}) {
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
