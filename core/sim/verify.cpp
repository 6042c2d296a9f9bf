// Invariants that hold in every step of every run: no vehicle overlaps one on another lane (on its own: full_dynamics.cpp), none
// is lost.
#include "sim/phases.h"

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

constexpr double kLongest_m = 50.0;  // no vehicle reaches back further than this

}  // namespace

void verify(const Model& model, State& state) {
    std::int64_t present = 0;
    for (int lane = 0; lane < static_cast<int>(state.blocks.size()); ++lane) {
        const LaneBlock& block = state.blocks[at(lane)];
        if (block.count == 0) continue;
        present += block.count;
        const double to_end_m = model.graph.lanes[at(lane)].length_m - state.vehicles.position_m[at(block.first)];
        if (to_end_m > kLongest_m) continue;
        const Ahead ahead = vehicle_ahead(model, state, lane, block.first, kLongest_m);
        if (ahead.slot < 0) continue;
        const double rear_m =
            ahead.start_m + state.vehicles.position_m[at(ahead.slot)] - state.vehicles.length_m[at(ahead.slot)];
        state.violations.overlaps += static_cast<std::int64_t>(rear_m < state.vehicles.position_m[at(block.first)]);
    }
    state.violations.lost_vehicles = state.entered - state.left - present;
}

}  // namespace stopline
