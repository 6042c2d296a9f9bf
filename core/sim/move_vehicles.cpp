// Lanes go through the kernels in groups that fit into the first-level cache.
#include <utility>

#include "sim/full_dynamics.h"
#include "sim/meso_dynamics.h"
#include "sim/phases.h"

namespace stopline {

namespace {

// The lanes from the k-th occupied one on that make up a group.
void collect_group(const Model& model, State& state, const NetworkPart& part, std::size_t& k, LaneGroup& group) {
    group.clear();
    for (; k < part.occupied.size() && group.vehicles < NetworkPart::kVehiclesTogether; ++k) {
        add_lane(model, state, part.occupied[k], group);
    }
    if (!group.lanes.empty()) group.protect(group.lanes.back().stop);
}

}  // namespace

void move_vehicles(const Model& model, const FullTables& tables, State& state, NetworkPart& part) {
    LaneGroup& group = part.groups[0];
    LaneGroup& next = part.groups[1];
    const bool prefetch = state.outgrows_cache();
    std::size_t seen = 0;
    collect_group(model, state, part, seen, group);
    part.ended.clear();
    for (std::size_t done = 0; !group.lanes.empty();) {
        collect_group(model, state, part, seen, next);
        if (model.meso) {
            step_meso(model, group, state, part);
        } else {
            step_full(model, tables, group,
                      prefetch ? std::span<const LaneStep>(next.lanes) : std::span<const LaneStep>(), state, part);
        }
        for (const std::size_t stop = done + static_cast<std::size_t>(group.lanes_of_network); done < stop; ++done) {
            const int lane = part.occupied[done];
            const auto first = static_cast<std::size_t>(state.blocks[static_cast<std::size_t>(lane)].first);
            if (state.vehicles.position_m[first] >= state.plan.lane(lane).length_m) part.ended.push_back(lane);
        }
        std::swap(group, next);
    }
}

}  // namespace stopline
