// Everybody moves. Full dynamics: lanes go through the kernels in groups that fit into the first-level cache.
#include <algorithm>
#include <utility>

#include "sim/full_dynamics.h"
#include "sim/meso_dynamics.h"
#include "sim/phases.h"

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

// `minding`: those of the part that have not been met yet.
void add_lane(const Model& model, const State& state, int lane, std::span<const Minding>& minding, LaneGroup& group) {
    const VehicleArrays& v = state.vehicles;
    const LaneBlock& block = state.blocks[at(lane)];
    const LanePlan& plan = state.plan.lane(lane);
    const auto stop_at = [&](int slot, double place_m) {
        const double room_m = place_m - v.position_m[at(slot)];
        group.imposed.push_back(
            {group.vehicles + slot - block.first, stop_at_line_mps2(model.driver, v.speed_mps[at(slot)], room_m)});
    };
    if (plan.signal_group >= 0 && state.stop_slot[at(lane)] >= 0) {
        stop_at(state.stop_slot[at(lane)], plan.stop_line_m - model.driver.stop.margin_m);
    }
    const Holds& holds = state.holds[at(lane)];
    for (int k = 0; k < holds.count; ++k) stop_at(holds.each[at(k)].slot, holds.each[at(k)].place_m);
    for (; !minding.empty() && block.has(minding.front().slot); minding = minding.subspan(1)) {
        group.imposed.push_back({group.vehicles + minding.front().slot - block.first, minding.front().asks_mps2});
    }
    for (const Adapting& adapting : state.adapting[at(lane)]) {
        constexpr double kWithin_s = 1.0;
        const double asks_mps2 = (adapting.most_mps - v.speed_mps[at(adapting.slot)]) / kWithin_s;
        group.imposed.push_back(
            {group.vehicles + adapting.slot - block.first, std::max(asks_mps2, -Adapting::kBraking_mps2)});
    }
    group.lanes.push_back({block.first, block.stop(), plan.turn_m, plan.limit_mps, static_cast<double>(plan.sine)});
    const int line = block.first / kSimdWidth * kSimdWidth;  // blocks and arrays begin with one
    for (int slot = line; slot < block.stop(); slot += kSimdWidth) group.lines.push_back(slot);
    group.vehicles += block.count;
}

// The lanes from the k-th occupied one on that make up a group.
void collect_group(const Model& model, const State& state, const NetworkPart& part, std::size_t& k,
                   std::span<const Minding>& minding, LaneGroup& group) {
    group.clear();
    for (; k < part.occupied.size() && group.vehicles < NetworkPart::kVehiclesTogether; ++k) {
        add_lane(model, state, part.occupied[k], minding, group);
    }
}

void step_full_groups(const Model& model, const FullTables& tables, State& state, NetworkPart& part) {
    LaneGroup& group = part.groups[0];
    LaneGroup& next = part.groups[1];
    const bool prefetch = state.outgrows_cache();
    std::size_t seen = 0;
    std::span<const Minding> minding = part.minding;
    collect_group(model, state, part, seen, minding, group);
    while (!group.lanes.empty()) {
        collect_group(model, state, part, seen, minding, next);
        part.full_group.make_room(group.vehicles);
        step_full(model, tables, group, prefetch ? std::span<const int>(next.lines) : std::span<const int>(), state,
                  part);
        std::swap(group, next);
    }
}

}  // namespace

void move_vehicles(const Model& model, const FullTables& tables, State& state, NetworkPart& part) {
    if (model.meso) {
        step_meso(model, state, part);
    } else {
        step_full_groups(model, tables, state, part);
    }
    part.ended.clear();
    for (const int lane : model.meso ? part.near_end : part.awake) {
        const int first = state.blocks[at(lane)].first;
        if (has_ended(state, lane, first)) part.ended.push_back(lane);
    }
}

}  // namespace stopline
