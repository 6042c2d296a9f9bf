// Invariants that hold in every step of every run: no vehicle overlaps another, none is lost.
#include "base/simd.h"
#include "sim/phases.h"

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

// Fronts that stand behind their predecessor's rear within a lane are counted, not the rest.
std::int64_t overlaps_in(const VehicleArrays& v, const LaneBlock& block) {
    constexpr double kRounding_m = 1e-6;
    std::int64_t overlaps = 0;
    for (int slot = block.first + 1; slot < block.stop(); ++slot) {
        const double gap_m = v.position_m[at(slot - 1)] - v.length_m[at(slot - 1)] - v.position_m[at(slot)];
        overlaps += static_cast<std::int64_t>(gap_m < -kRounding_m);
    }
    return overlaps;
}

}  // namespace

void verify(const Model& model, State& state) {
    std::int64_t present = 0;
    for (int lane = 0; lane < static_cast<int>(state.blocks.size()); ++lane) {
        const LaneBlock& block = state.blocks[at(lane)];
        if (block.count == 0) continue;
        present += block.count;
        state.violations.overlaps += overlaps_in(state.vehicles, block);
        const Ahead ahead = vehicle_ahead(model, state, lane, block.first, 50.0);
        if (ahead.slot < 0) continue;
        const double rear_m =
            ahead.start_m + state.vehicles.position_m[at(ahead.slot)] - state.vehicles.length_m[at(ahead.slot)];
        state.violations.overlaps += static_cast<std::int64_t>(rear_m < state.vehicles.position_m[at(block.first)]);
    }
    state.violations.lost_vehicles = state.entered - state.left - present;
}

}  // namespace stopline
