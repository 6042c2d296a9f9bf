#include "sim/state/queries/covered_detector.h"

#include <array>
#include <span>

#include "base/containers/index.h"
#include "sim/state/queries/gap.h"

namespace stopline {

namespace {

// Returns true if a vehicle on a later lane has come along `path` and its rear is before `end_m`, from the start of the
// first lane. `path`: the lane of a detector, the following lane and, if there is a third lane, the one after that.
bool reaches_back(const State& state, std::span<const int> path, double length_m, double end_m) {
    const VehicleArrays& v = state.vehicles;
    const LaneBlock& block = state.blocks[at(path.back())];
    for (int slot = block.past_last() - 1; slot >= block.first; --slot) {
        if (length_m + rear_m(v, slot) >= end_m) return false;
        const VehicleRecord& record = v.record[at(slot)];
        if (record.previous_lane != path[path.size() - 2]) continue;  // it has come from another lane
        if (path.size() == 2 || record.second_previous_lane == path.front()) return true;
    }
    return false;
}

}  // namespace

bool is_covered(const Model& model, const State& state, std::size_t detector) {
    const VehicleArrays& v = state.vehicles;
    const double line_m = model.detectors[detector].position_m;
    const double end_m = line_m + model.detectors[detector].length_m;
    const int own = model.detectors[detector].lane;
    const Lane& lane = model.graph.lanes[at(own)];
    const LaneBlock& block = state.blocks[at(own)];
    for (int slot = block.first; slot < block.past_last(); ++slot) {
        if (v.position_m[at(slot)] < line_m) break;
        if (rear_m(v, slot) < end_m) return true;
    }
    for (const int next : lane.next) {
        if (reaches_back(state, std::array{own, next}, lane.length_m, end_m)) return true;
        const Lane& following = model.graph.lanes[at(next)];
        for (const int second : following.next) {
            if (reaches_back(state, std::array{own, next, second}, lane.length_m + following.length_m, end_m))
                return true;
        }
    }
    return false;
}

}  // namespace stopline
