#include "record/recording/snapshot.h"

#include <algorithm>

#include "base/containers/index.h"
#include "record/recording/recording_format.h"
#include "sim/state/queries/stopped_vehicles.h"

namespace stopline {

namespace {

constexpr double kSpeedUnitsPer_mps = 1.0 / kSpeedUnit_mps;
constexpr double kMaxCode = 65535.0;

// Converts the value to a rounded number of units, limited to 16 bits. The two comparisons are written so that they
// compile to one maximum and one minimum instruction.
std::uint32_t code_of(double value, double units_per_value) {
    const double code = value * units_per_value + 0.5;
    const double clipped = code > 0.0 ? code : 0.0;
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(clipped < kMaxCode ? clipped : kMaxCode));
}

void encode_motion(const double* position_m, const double* speed_mps, int count, double positions_per_m,
                   std::uint32_t* motion) {
    for (int k = 0; k < count; ++k) {
        motion[k] = code_of(position_m[k], positions_per_m) | code_of(speed_mps[k], kSpeedUnitsPer_mps) << 16U;
    }
}

// Returns true if the arrays differ. The loop always visits all elements, so that the compiler can vectorise it.
bool differ(const int* a, const int* b, int count) {
    int bits = 0;
    for (int k = 0; k < count; ++k) bits |= a[k] ^ b[k];
    return bits != 0;
}

void copy_stopped(const State& state, std::vector<Snapshot::StoppedVehicle>& copies) {
    copies.clear();
    for_each_stopped_vehicle(state, [&](const StoppedVehicle& stopped) {
        copies.push_back({stopped.vehicle, stopped.waits_for, stopped.cause});
    });
}

}  // namespace

SnapshotTaker::SnapshotTaker(const Model& model, const FrameGrid& grid)
    : positions_per_m_(1.0 / grid.position_unit_m),
      link_kinds_(link_kinds_of(model)),
      lanes_(model.graph.lanes.size()) {}

void SnapshotTaker::start_section() { std::fill(vehicle_in_slot_.begin(), vehicle_in_slot_.end(), -1); }

void SnapshotTaker::take(const State& state, bool with_stopped, Snapshot& snapshot) {
    const VehicleArrays& vehicles = state.vehicles;
    snapshot.tick = state.tick;
    snapshot.entered = state.records.entered;
    snapshot.exited = state.records.exited;
    snapshot.lights = state.signals.lights;
    if (vehicle_in_slot_.size() < at(vehicles.slots)) {
        vehicle_in_slot_.resize(at(vehicles.slots), -1);
        next_lane_in_slot_.resize(at(vehicles.slots), -1);
    }
    snapshot.placements.clear();
    snapshot.motion.resize(update_lanes(state, snapshot));
    std::uint32_t* motion = snapshot.motion.data();
    for (std::size_t lane = 0; lane < lanes_.size(); ++lane) {
        const Snapshot::Slots slots = lanes_[lane];
        if (slots.count == 0) continue;
        const std::size_t first = at(slots.first);
        encode_motion(&vehicles.position_m[first], &vehicles.speed_mps[first], slots.count, positions_per_m_, motion);
        if (differ(&vehicles.id[first], &vehicle_in_slot_[first], slots.count) ||
            differ(&vehicles.next_lane[first], &next_lane_in_slot_[first], slots.count)) {
            add_placements(vehicles, static_cast<int>(lane), snapshot);
        }
        motion += slots.count;
    }
    if (with_stopped) copy_stopped(state, snapshot.stopped);
    snapshot.links.clear();
    for (std::size_t k = 0; k < link_kinds_.size(); ++k)
        link_kinds_[k]->add(state, static_cast<int>(k), snapshot.links);
}

// Copies the range of slots of each lane (a slot is the index of a vehicle in the arrays of the simulation) and returns
// the number of vehicles. Marks slots that a range no longer contains as empty. Call this function before
// add_placements(), which can put vehicles of other lanes into these slots.
std::size_t SnapshotTaker::update_lanes(const State& state, Snapshot& snapshot) {
    std::size_t vehicles = 0;
    for (std::size_t lane = 0; lane < lanes_.size(); ++lane) {
        const Snapshot::Slots now{state.blocks[lane].first, state.blocks[lane].count};
        const Snapshot::Slots before = lanes_[lane];
        vehicles += at(now.count);
        if (now == before) continue;
        for (int slot = before.first; slot < before.past_last(); ++slot) {
            if (slot < now.first || slot >= now.past_last()) vehicle_in_slot_[at(slot)] = -1;
        }
        lanes_[lane] = now;
    }
    snapshot.lanes = lanes_;
    return vehicles;
}

void SnapshotTaker::add_placements(const VehicleArrays& vehicles, int lane, Snapshot& snapshot) {
    const Snapshot::Slots slots = lanes_[at(lane)];
    for (int slot = slots.first; slot < slots.past_last(); ++slot) {
        const int vehicle = vehicles.id[at(slot)];
        const int next_lane = vehicles.next_lane[at(slot)];
        if (vehicle == vehicle_in_slot_[at(slot)] && next_lane == next_lane_in_slot_[at(slot)]) continue;
        vehicle_in_slot_[at(slot)] = vehicle;
        next_lane_in_slot_[at(slot)] = next_lane;
        snapshot.placements.push_back(
            {slot, lane, vehicle, vehicles.policy[at(slot)], next_lane, vehicles.length_m[at(slot)]});
    }
}

}  // namespace stopline
