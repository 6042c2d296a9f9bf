#include "record/snapshot.h"

#include <algorithm>

#include "record/recording_format.h"

namespace stopline {

namespace {

constexpr double kSpeedsPer_mps = 1.0 / kSpeedUnit_mps;
constexpr double kMostCode = 65535.0;

std::size_t at(int index) { return static_cast<std::size_t>(index); }

// Written so that it becomes one maximum and one minimum.
std::uint32_t code_of(double value, double per_unit) {
    const double code = value * per_unit + 0.5;
    const double least = code > 0.0 ? code : 0.0;
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(least < kMostCode ? least : kMostCode));
}

void code_motion(const double* position_m, const double* speed_mps, int count, double positions_per_m,
                 std::uint32_t* motion) {
    for (int k = 0; k < count; ++k) {
        motion[k] = code_of(position_m[k], positions_per_m) | code_of(speed_mps[k], kSpeedsPer_mps) << 16U;
    }
}

// Without a way out of the loop, so that many are compared at a time.
bool differ(const int* a, const int* b, int count) {
    int bits = 0;
    for (int k = 0; k < count; ++k) bits |= a[k] ^ b[k];
    return bits != 0;
}

void copy_standing(const HindranceWatch& watch, std::vector<Snapshot::Standing>& standing) {
    standing.resize(watch.standing.size());
    for (std::size_t k = 0; k < standing.size(); ++k) {
        const std::size_t slot = at(watch.standing[k]);
        const int ahead = watch.waits_for[slot];
        standing[k] = {watch.vehicle[slot], ahead < 0 ? -1 : watch.vehicle[at(ahead)], watch.cause[slot]};
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
    shot.guests.clear();
    shot.past_line.clear();
    shot.motion.resize(note_lanes(state, shot));
    std::uint32_t* motion = shot.motion.data();
    for (std::size_t lane = 0; lane < lanes_.size(); ++lane) {
        const Snapshot::Slots slots = lanes_[lane];
        if (slots.count == 0) continue;
        const std::size_t first = at(slots.first);
        code_motion(&vehicles.position_m[first], &vehicles.speed_mps[first], slots.count, positions_per_m_, motion);
        if (differ(&vehicles.id[first], &guest_[first], slots.count)) {
            note_guests(vehicles, static_cast<int>(lane), shot);
        }
        note_past_line(vehicles, static_cast<int>(lane), motion, shot);
        motion += slots.count;
    }
    if (with_standing) copy_standing(state.watch, shot.standing);
}

// Slots that a lane had and has no more; another may have them now, so that this comes before anybody is seen there. The
// number of vehicles.
std::size_t SnapshotTaker::note_lanes(const State& state, Snapshot& shot) {
    std::size_t vehicles = 0;
    for (std::size_t lane = 0; lane < lanes_.size(); ++lane) {
        const Snapshot::Slots now{state.blocks[lane].first, state.blocks[lane].count};
        const Snapshot::Slots before = lanes_[lane];
        vehicles += at(now.count);
        if (now == before) continue;
        for (int slot = before.first; slot < before.stop(); ++slot) {
            if (slot < now.first || slot >= now.stop()) guest_[at(slot)] = -1;
        }
        lanes_[lane] = now;
    }
    shot.lanes = lanes_;
    return vehicles;
}

void SnapshotTaker::note_guests(const VehicleArrays& vehicles, int lane, Snapshot& shot) {
    const Snapshot::Slots slots = lanes_[at(lane)];
    for (int slot = slots.first; slot < slots.stop(); ++slot) {
        const int vehicle = vehicles.id[at(slot)];
        if (vehicle == guest_[at(slot)]) continue;
        guest_[at(slot)] = vehicle;
        shot.guests.push_back({slot, lane, vehicle, vehicles.policy[at(slot)], vehicles.next_lane[at(slot)],
                               vehicles.length_m[at(slot)]});
    }
}

void SnapshotTaker::note_past_line(const VehicleArrays& vehicles, int lane, const std::uint32_t* motion,
                                   Snapshot& shot) const {
    const Snapshot::Slots slots = lanes_[at(lane)];
    for (int slot = slots.first; slot < slots.stop() && position_of(*motion) > stop_line_[at(lane)]; ++slot, ++motion) {
        shot.past_line.push_back({slot, lane, vehicles.next_lane[at(slot)]});
    }
}

}  // namespace stopline
