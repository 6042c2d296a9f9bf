// Fronts that pass detectors. The vehicles of a lane pass in order, so each detector has one to look at: the first of those
// upstream of it.
#include "sim/phases.h"

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

void pass_stop_line(const Model& model, State& state, int lane, int slot) {
    state.vehicles.inside_since[at(slot)] = static_cast<int>(state.tick);
    const Lane& road = model.graph.lanes[at(lane)];
    if (state.lights[at(road.signal_group)] != Light::red) return;
    // Whoever was told to stop was told so because it could.
    if (state.stop_lines[at(lane)].stopper == state.vehicles.id[at(slot)]) {
        ++state.violations.red_entries;
    } else {
        ++state.violations.forced_red_entries;
    }
}

}  // namespace

void watch_detectors(const Model& model, State& state) {
    const VehicleArrays& v = state.vehicles;
    for (std::size_t k = 0; k < model.detectors.size(); ++k) {
        const Detector& detector = model.detectors[k];
        const LaneBlock& block = state.blocks[at(detector.lane)];
        int& upstream = state.upstream[k];
        for (; upstream > 0; --upstream) {
            const int slot = block.stop() - upstream;
            if (v.position_m[at(slot)] < detector.position_m) break;
            const bool recorded = model.records_all || detector.kind == Detector::Kind::zone;
            if (recorded)
                state.crossings.push_back({passing_time_s(model, state, slot, detector.position_m), v.id[at(slot)],
                                           v.policy[at(slot)], static_cast<int>(k),
                                           static_cast<float>(v.speed_mps[at(slot)]), v.length_m[at(slot)]});
            if (detector.kind == Detector::Kind::stop_line) pass_stop_line(model, state, detector.lane, slot);
        }
    }
}

}  // namespace stopline
