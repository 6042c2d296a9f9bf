#include "sim/state/queries/covered_detector.h"

#include "base/containers/index.h"

namespace stopline {

bool is_covered(const Model& model, const State& state, std::size_t detector) {
    const VehicleArrays& v = state.vehicles;
    const double line_m = model.detectors[detector].position_m;
    const double end_m = line_m + model.detectors[detector].length_m;
    const Lane& lane = model.graph.lanes[at(model.detectors[detector].lane)];
    const LaneBlock& block = state.blocks[at(model.detectors[detector].lane)];
    for (int slot = block.first; slot < block.past_last(); ++slot) {
        if (v.position_m[at(slot)] < line_m) break;
        if (v.position_m[at(slot)] - static_cast<double>(v.length_m[at(slot)]) < end_m) return true;
    }
    for (const int next : lane.next) {
        const LaneBlock& beyond = state.blocks[at(next)];
        if (beyond.count == 0 || model.graph.lanes[at(next)].origin < 0) continue;
        const std::size_t last = at(beyond.last());
        if (lane.length_m + v.position_m[last] - static_cast<double>(v.length_m[last]) < end_m) return true;
    }
    return false;
}

}  // namespace stopline
