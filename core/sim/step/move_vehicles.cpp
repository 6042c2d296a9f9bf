#include "sim/step/move_vehicles.h"

#include <algorithm>
#include <span>
#include <utility>

#include "base/containers/index.h"
#include "base/simd/simd.h"
#include "sim/full_dynamics/full_dynamics.h"
#include "sim/mesoscale/meso_dynamics.h"
#include "sim/state/queries/lane_end.h"

namespace stopline {

namespace {

// Appends a lane and its demands to a group. A demand is an acceleration that a vehicle must not exceed because of a
// stop line, yielding, a hidden leader (perception/hidden_leaders.h), a speed target or a prescription.
// `hidden_leader_demands` lists the demands because of hidden leaders, in the order of slots. The function takes the
// demands on the vehicles of this lane off this list.
void add_lane(const Model& model, const State& state, int lane, std::span<const BrakingDemand>& hidden_leader_demands,
              LaneGroup& group) {
    const VehicleArrays& v = state.vehicles;
    const LaneBlock& block = state.blocks[at(lane)];
    const LanePlan& plan = state.plan.lane(lane);
    const auto demand = [&](int slot, double acceleration_mps2) {
        group.demands.push_back({group.vehicles + slot - block.first, acceleration_mps2});
    };
    const auto driver_of = [&](int slot) -> const DriverTables& { return model.driver_of(v.policy[at(slot)]).tables; };
    const auto stop_at = [&](int slot, double position_m) {
        const double room_m = position_m - v.position_m[at(slot)];
        demand(slot, stop_at_line_acceleration(driver_of(slot), v.speed_mps[at(slot)], room_m));
    };
    const int stop_slot = plan.signal_group >= 0 ? state.stop_lines.stop_slot[at(lane)] : -1;
    if (stop_slot >= 0) {
        stop_at(stop_slot, plan.stop_line_m - driver_of(stop_slot).stop.margin_m);
    }
    const YieldStops& yield_stops = yield_stops_of(state, lane);
    for (int k = 0; k < yield_stops.count; ++k) {
        stop_at(yield_stops.stops[at(k)].slot, yield_stops.stops[at(k)].position_m);
    }
    while (!hidden_leader_demands.empty() && block.has(hidden_leader_demands.front().slot)) {
        demand(hidden_leader_demands.front().slot, hidden_leader_demands.front().acceleration_mps2);
        hidden_leader_demands = hidden_leader_demands.subspan(1);
    }
    const int place = state.speed_targets_place[at(lane)];
    for (const SpeedTarget& target : state.partition_of(lane).speed_targets.at_place(place)) {
        const double acceleration_mps2 =
            (target.target_speed_mps - v.speed_mps[at(target.slot)]) / SpeedTarget::kTimeToTarget_s;
        demand(target.slot, std::max(acceleration_mps2, -target.deceleration_mps2));
    }
    if (state.prescribed.vehicle >= 0 && v.id[at(block.first)] == state.prescribed.vehicle) {
        demand(block.first, state.prescribed.acceleration_mps2);
    }
    group.lanes.push_back({block.first, block.past_last(), plan.next_limit_m, plan.limit_mps,
                           static_cast<double>(plan.sine), state.plan.intersection_of(lane)});
    // For the prefetching, list one slot for each cache line. A cache line begins at each multiple of kSimdWidth.
    const int first_of_line = block.first / kSimdWidth * kSimdWidth;
    for (int slot = first_of_line; slot < block.past_last(); slot += kSimdWidth) group.prefetch_slots.push_back(slot);
    group.vehicles += block.count;
}

// Clears a group and fills it with occupied lanes, starting with the k-th occupied lane, until the group has at least
// group_vehicles() vehicles or no lane is left. Advances k to the first lane after the group.
void collect_group(const Model& model, const State& state, const Partition& part, std::size_t& k,
                   std::span<const BrakingDemand>& hidden_leader_demands, LaneGroup& group) {
    group.clear();
    const int most = Partition::group_vehicles(state.vehicles.has_v2v_channel);
    for (; k < part.occupied.size() && group.vehicles < most; ++k) {
        add_lane(model, state, part.occupied[k], hidden_leader_demands, group);
    }
}

// Full dynamics: moves the vehicles of a partition, one lane group after the other. The data of a group fit into the
// first-level cache.
void step_full_groups(const Model& model, const FullTables& tables, State& state, Partition& part) {
    LaneGroup& group = part.groups[0];
    LaneGroup& next = part.groups[1];
    // With a V2V channel, a vehicle has more data, so fewer vehicles fill the second-level cache.
    constexpr int kFillCacheWithChannel = 1000;
    const bool prefetch =
        state.outgrows_cache() || (state.vehicles.has_v2v_channel && state.present() > kFillCacheWithChannel);
    std::size_t k = 0;
    std::span<const BrakingDemand> hidden_leader_demands = part.extra_demands;
    collect_group(model, state, part, k, hidden_leader_demands, group);
    while (!group.lanes.empty()) {
        collect_group(model, state, part, k, hidden_leader_demands, next);
        part.full_group.reserve(group.vehicles);
        const std::span<const int> next_slots =
            prefetch ? std::span<const int>(next.prefetch_slots) : std::span<const int>();
        step_full(model, tables, group, next_slots, state, part);
        std::swap(group, next);
    }
}

}  // namespace

void move_vehicles(const Model& model, const FullTables& tables, State& state, Partition& part) {
    if (model.meso) {
        step_meso(model, state, part);
    } else {
        step_full_groups(model, tables, state, part);
    }
    part.lanes_to_transfer.clear();
    for (const int lane : model.meso ? part.lanes_near_end : part.awake) {
        const int first = state.blocks[at(lane)].first;
        if (has_left_lane(state, lane, first)) part.lanes_to_transfer.push_back(lane);
    }
}

}  // namespace stopline
