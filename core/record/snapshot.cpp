#include "record/snapshot.h"

#include <algorithm>

#include "record/recording_format.h"

namespace stopline {

namespace {

constexpr double kSpeedsPer_mps = 1.0 / kSpeedUnit_mps;
constexpr double kMostCode = 65535.0;

std::size_t at(int index) { return static_cast<std::size_t>(index); }

// Written so that it becomes a maximum and a minimum of many values at a time.
int code_of(double value, double per_unit) {
    const double code = value * per_unit + 0.5;
    const double least = code > 0.0 ? code : 0.0;
    return static_cast<int>(least < kMostCode ? least : kMostCode);
}

void copy_standing(const HindranceWatch& watch, std::vector<Snapshot::Standing>& standing) {
    standing.resize(watch.standing.size());
    for (std::size_t k = 0; k < standing.size(); ++k) {
        const int slot = watch.standing[k];
        const int ahead = watch.waits_for[at(slot)];
        standing[k] = {slot, watch.vehicle[at(slot)], watch.cause[at(slot)], ahead < 0 ? -1 : watch.vehicle[at(ahead)]};
    }
}

}  // namespace

SnapshotTaker::SnapshotTaker(const Model& model, const FrameGrid& grid)
    : positions_per_m_(1.0 / grid.position_unit_m), lanes_(model.graph.lanes.size()) {
    for (const Lane& lane : model.graph.lanes) {
        const double line_m = lane.signal_group >= 0 ? lane.stop_line_m : lane.length_m;
        stop_line_.push_back(code_of(line_m, positions_per_m_));
    }
}

void SnapshotTaker::start_afresh() { std::fill(guest_.begin(), guest_.end(), -1); }

void SnapshotTaker::take(const State& state, bool with_standing, Snapshot& shot) {
    const VehicleArrays& vehicles = state.vehicles;
    shot.tick = state.tick;
    shot.entered = state.entered;
    shot.left = state.left;
    if (guest_.size() < at(vehicles.slots)) guest_.resize(at(vehicles.slots), -1);
    shot.position.resize(at(vehicles.slots));
    shot.speed.resize(at(vehicles.slots));
    shot.guests.clear();
    shot.past_line.clear();
    note_lanes(state, shot);
    for (std::size_t lane = 0; lane < lanes_.size(); ++lane) {
        if (lanes_[lane].count == 0) continue;
        note_motion(vehicles, lanes_[lane], shot);
        note_guests(vehicles, static_cast<int>(lane), shot);
    }
    if (with_standing) copy_standing(state.watch, shot.standing);
}

// Slots that a lane had and has no more; another may have them now, so that this comes before anybody is seen there.
void SnapshotTaker::note_lanes(const State& state, Snapshot& shot) {
    for (std::size_t lane = 0; lane < lanes_.size(); ++lane) {
        const Snapshot::Slots now{state.blocks[lane].first, state.blocks[lane].count};
        const Snapshot::Slots before = lanes_[lane];
        if (now == before) continue;
        for (int slot = before.first; slot < before.stop(); ++slot) {
            if (slot < now.first || slot >= now.stop()) guest_[at(slot)] = -1;
        }
        lanes_[lane] = now;
    }
    shot.lanes = lanes_;
}

void SnapshotTaker::note_guests(const VehicleArrays& vehicles, int lane, Snapshot& shot) {
    const Snapshot::Slots slots = lanes_[at(lane)];
    const auto first = vehicles.id.begin() + slots.first;
    const bool changed = !std::equal(first, first + slots.count, guest_.begin() + slots.first);
    for (int slot = slots.first; changed && slot < slots.stop(); ++slot) {
        const int vehicle = vehicles.id[at(slot)];
        if (vehicle == guest_[at(slot)]) continue;
        guest_[at(slot)] = vehicle;
        shot.guests.push_back({slot, lane, vehicle, vehicles.policy[at(slot)], vehicles.record[at(slot)].next_lane,
                               vehicles.length_m[at(slot)]});
    }
    const int stop_line = stop_line_[at(lane)];
    for (int slot = slots.first; slot < slots.stop() && shot.position[at(slot)] > stop_line; ++slot) {
        shot.past_line.push_back({slot, lane, vehicles.record[at(slot)].next_lane});
    }
}

void SnapshotTaker::note_motion(const VehicleArrays& vehicles, const Snapshot::Slots& slots, Snapshot& shot) const {
    const double* const position_m = vehicles.position_m.data();
    const double* const speed_mps = vehicles.speed_mps.data();
    int* const position = shot.position.data();
    int* const speed = shot.speed.data();
    const double positions_per_m = positions_per_m_;
    for (std::size_t i = at(slots.first); i < at(slots.stop()); ++i) {
        position[i] = code_of(position_m[i], positions_per_m);
        speed[i] = code_of(speed_mps[i], kSpeedsPer_mps);
    }
}

}  // namespace stopline
