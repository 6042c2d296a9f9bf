#include "sim/state.h"

#include <algorithm>
#include <cmath>

#include "base/arithmetic.h"

namespace stopline {

namespace {

int rounded_up(int n) { return (n + kSimdWidth - 1) / kSimdWidth * kSimdWidth; }

// Room for all vehicles that fit on the lane bumper to bumper and half as many more, so that moving up is rare.
int block_size(const Model& model, const Lane& lane) {
    double shortest_m = 1e9;
    for (const PowertrainTables& type : model.vehicles) shortest_m = std::min(shortest_m, type.length_m);
    const int most = static_cast<int>(lane.length_m / shortest_m) + 2;
    return rounded_up(most + std::max(most / 2, kSimdWidth));
}

}  // namespace

Rows rows_at(const DelayLine& line, std::int64_t tick, int slots) {
    const std::int64_t present = tick % line.rows;
    const auto row = [&](int age) {  // at most `rows`
        const std::int64_t wrapped = present >= age ? present - age : present - age + line.rows;
        return static_cast<std::size_t>(wrapped) * static_cast<std::size_t>(slots);
    };
    return {row(0), row(1), row(line.steps), row(line.steps + 1), 1.0 - line.share, line.share};
}

void Holds::add(const Hold& hold) {
    int place = count;
    while (place > 0 && each[static_cast<std::size_t>(place - 1)].slot > hold.slot) --place;
    if (place == kMost) return;
    count = std::min(count + 1, kMost);
    for (int k = count - 1; k > place; --k) each[static_cast<std::size_t>(k)] = each[static_cast<std::size_t>(k - 1)];
    each[static_cast<std::size_t>(place)] = hold;
}

State make_state(const Model& model) {
    State state;
    int slots = 0;
    for (const Lane& lane : model.graph.lanes) {
        LaneBlock block;
        block.begin = slots + kSimdWidth;
        block.end = block.begin + block_size(model, lane);
        block.first = block.begin;
        slots = block.end;
        state.blocks.push_back(block);
        state.sine.push_back(lane.gradient / std::sqrt(1.0 + square(lane.gradient)));
    }
    if (model.rules.teleport_ticks > 0) {
        const int most = rounded_up(64 + static_cast<int>(model.graph.lanes.size()));
        state.limbo = {slots + kSimdWidth, slots + kSimdWidth + most, slots + kSimdWidth, 0};
        slots = state.limbo.end;
    }
    slots = rounded_up(slots) + kSimdWidth;  // the last batch of a lane reaches beyond its block
    state.vehicles.resize(slots, model.radar.rows, model.v2v.rows);
    state.lights.assign(model.signals.size(), Light::red);
    state.stop_lines.resize(model.graph.lanes.size());
    state.stop_slot.assign(model.graph.lanes.size(), -1);
    state.holds.resize(model.graph.lanes.size());
    state.kept_out.resize(model.graph.lanes.size());
    state.insiders.resize(model.graph.lanes.size());
    for (std::vector<Insider>& insiders : state.insiders) insiders.reserve(32);
    state.detectors_of.resize(model.graph.lanes.size());
    state.upstream.assign(model.detectors.size(), 0);
    for (std::size_t k = 0; k < model.detectors.size(); ++k) {
        state.detectors_of[static_cast<std::size_t>(model.detectors[k].lane)].push_back(static_cast<int>(k));
    }
    state.occupied.reserve(model.graph.lanes.size());
    state.inlets.resize(model.demand.inlets.size());
    state.inlet_of.assign(model.graph.lanes.size(), -1);
    for (std::size_t k = 0; k < model.demand.inlets.size(); ++k) {
        state.inlet_of[static_cast<std::size_t>(model.demand.inlets[k].lane)] = static_cast<int>(k);
    }
    int longest = 0;
    for (const LaneBlock& block : state.blocks) longest = std::max(longest, block.end - block.begin);
    const int together = State::kVehiclesTogether + longest + kSimdWidth;
    state.group.resize(model.meso ? 0 : together);
    state.meso_group.resize(model.meso ? together : 0);
    state.lane_steps.reserve(model.graph.lanes.size());
    std::size_t expected = 0;
    for (const DemandPlan::Inlet& inlet : model.demand.inlets) {
        expected += static_cast<std::size_t>(std::min<std::int64_t>(inlet.vehicles, 2000));
    }
    state.passages.reserve(4 * expected);
    return state;
}

}  // namespace stopline
