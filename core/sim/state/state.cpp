#include "sim/state/state.h"

#include <algorithm>

#include "base/containers/index.h"
#include "sim/state/lane_blocks.h"

namespace stopline {

DelayRows delay_rows_at(const DelayLine& line, std::int64_t tick, int slots) {
    const std::int64_t present = tick % line.rows;
    const auto row = [&](int age) {  // age: number of steps before `tick`; at most line.rows
        const std::int64_t wrapped = present >= age ? present - age : present - age + line.rows;
        return static_cast<std::size_t>(wrapped) * static_cast<std::size_t>(slots);
    };
    return {row(0), row(line.steps), row(line.steps + 1), 1.0 - line.share, line.share};
}

void YieldStops::add(const YieldStop& stop) {
    int index = count;
    while (index > 0 && stops[at(index - 1)].slot > stop.slot) --index;
    if (index == kCapacity) return;
    count = std::min(count + 1, kCapacity);
    for (int k = count - 1; k > index; --k) stops[at(k)] = stops[at(k - 1)];
    stops[at(index)] = stop;
}

void add_yield_stop(JunctionState& junctions, Partition& part, int lane, const YieldStop& stop) {
    int& index = junctions.yield_stops_index[at(lane)];
    if (index < 0) {
        index = static_cast<int>(part.lanes_with_yield_stops.size());
        part.lanes_with_yield_stops.push_back(lane);
        part.yield_stops.emplace_back();
    }
    part.yield_stops[at(index)].add(stop);
}

void clear_yield_stops(JunctionState& junctions, Partition& part) {
    for (const int lane : part.lanes_with_yield_stops) junctions.yield_stops_index[at(lane)] = -1;
    part.lanes_with_yield_stops.clear();
    part.yield_stops.clear();
}

const YieldStops& yield_stops_of(const State& state, int lane) {
    static const YieldStops kNone;
    const int index = state.junctions.yield_stops_index[at(lane)];
    if (index < 0) return kNone;
    return state.partition_of(lane).yield_stops[at(index)];
}

namespace {

// Splits the network into partitions with about the same total length of lanes. No intersection is split.
std::vector<Partition> make_partitions(const Model& model, const State& state, int threads) {
    const LargeArray<int>& order = state.plan.lane_order();
    const auto length_of = [&](int lane) { return state.plan.lane(lane).length_m; };
    double total_m = 0.0;
    double longest_m = 0.0;
    for (const int lane : order) total_m += length_of(lane), longest_m = std::max(longest_m, length_of(lane));
    // The lanes and vehicles of one intersection take about 15 kB. The data of a partition should fit into the
    // second-level cache. The number was chosen by measurement: with a million vehicles, smaller partitions are slower.
    constexpr int kIntersections = 32;
    const int count = std::max(threads, state.plan.intersection_count() / kIntersections);
    std::vector<std::vector<int>> detectors(order.size());
    for (std::size_t k = 0; k < model.detectors.size(); ++k) {
        if (model.detectors[k].lane >= 0) detectors[at(model.detectors[k].lane)].push_back(static_cast<int>(k));
    }
    std::vector<bool> is_exit(order.size(), false);
    std::vector<Partition> partitions(1);
    double done_m = 0.0;
    for (std::size_t k = 0; k < order.size(); ++k) {
        const int lane = order[k];
        const bool new_intersection =
            k > 0 && state.plan.intersection_of(lane) != state.plan.intersection_of(order[k - 1]);
        const double share_m = total_m / count * static_cast<double>(partitions.size());
        if (new_intersection && done_m >= share_m && static_cast<int>(partitions.size()) < count) {
            partitions.emplace_back();
        }
        done_m += length_of(lane);
        Partition& part = partitions.back();
        part.lanes.push_back(lane);
        part.detectors.insert(part.detectors.end(), detectors[at(lane)].begin(), detectors[at(lane)].end());
        if (state.plan.lane(lane).origin < 0 || model.graph.conflicts_of(lane).empty()) continue;
        const std::size_t word = at(state.plan.lane(lane).bitset_index) / Bitset::kWordBits;
        if (part.connections.empty()) part.first_word = word;
        part.end_word = word + 1;
        part.connections.push_back(lane);
        const int exit = state.plan.lane(lane).exit;
        if (!is_exit[at(exit)]) part.exits.push_back(exit);
        is_exit[at(exit)] = true;
    }
    // Lanes are added to a lane group until the group has group_vehicles() vehicles. The lane added last can make the
    // group larger by as many vehicles as fit on this lane.
    const int group_vehicles = Partition::group_vehicles(model.v2v_plan.is_active) +
                               static_cast<int>(longest_m / shortest_vehicle_m(model)) + 2 * kSimdWidth;
    for (Partition& part : partitions) {
        part.full_group.resize(model.meso ? 0 : group_vehicles);
    }
    return partitions;
}

void locate_lanes(State& state) {
    state.location_of.resize(state.plan.lane_order().size());
    for (std::size_t number = 0; number < state.partitions.size(); ++number) {
        Partition& part = state.partitions[number];
        part.occupied_candidates.resize(part.lanes.size());
        part.exit_candidates.resize(part.exits.size());
        for (std::size_t index = 0; index < part.lanes.size(); ++index) {
            state.location_of[at(part.lanes[index])].partition = static_cast<int>(number);
            state.location_of[at(part.lanes[index])].index = static_cast<int>(index);
        }
        for (std::size_t index = 0; index < part.exits.size(); ++index) {
            state.location_of[at(part.exits[index])].exit_partition = static_cast<int>(number);
            state.location_of[at(part.exits[index])].exit_index = static_cast<int>(index);
        }
    }
}

void size_junctions(const Model& model, JunctionState& junctions, const State& state) {
    const std::size_t lanes = model.graph.lanes.size();
    junctions.yield_stops_index.assign(lanes, -1);
    junctions.occupants_place.assign(lanes, -1);
    junctions.approaching_place.assign(lanes, -1);
    for (Bitset* set : {&junctions.occupied, &junctions.with_stopped, &junctions.to_decide}) {
        set->resize(state.plan.bitset_size());
    }
}

void size_detectors(const Model& model, DetectorState& detectors) {
    detectors.upstream.assign(model.detectors.size(), 0);
    detectors.last_crossing_tick.assign(model.detectors.size(), -1);
    std::vector<std::vector<int>> on_lane(model.graph.lanes.size());
    for (std::size_t k = 0; k < model.detectors.size(); ++k) {
        if (model.detectors[k].lane < 0) continue;
        on_lane[at(model.detectors[k].lane)].push_back(static_cast<int>(k));
    }
    for (const std::vector<int>& of_lane : on_lane) detectors.on_lane.add(of_lane);
}

void size_insertion(const Model& model, InsertionState& insertion) {
    const std::size_t approaches = model.graph.approaches.size();
    insertion.drawn_turns.resize(approaches);
    if (!model.demand.trips.empty()) {
        insertion.waiting_trips.resize(approaches);
        insertion.trip_delays.resize(approaches);
    }
    insertion.inlets.resize(model.demand.inlets.size());
    insertion.inlet_of.assign(model.graph.lanes.size(), -1);
    for (std::size_t k = 0; k < model.demand.inlets.size(); ++k) {
        insertion.inlet_of[at(model.demand.inlets[k].lane)] = static_cast<int>(k);
        insertion.open_inlets.push_back(static_cast<int>(k));
    }
}

}  // namespace

State make_state(const Model& model, int threads) {
    State state(model);
    state.partitions = make_partitions(model, state, threads);
    locate_lanes(state);
    allocate_lane_blocks(model, state);
    const std::size_t lanes = model.graph.lanes.size();
    state.stop_lines.lines.resize(lanes);
    state.stop_lines.stop_slot.assign(lanes, -1);
    state.stop_lines.held_at_green.resize(lanes);
    state.stop_lines.exit_rooms.resize(lanes);
    size_junctions(model, state.junctions, state);
    state.speed_targets_place.assign(lanes, -1);
    state.queues.standing.resize(lanes);
    state.queues.sleeps_until_green.assign(lanes, -1);
    size_detectors(model, state.detectors);
    size_insertion(model, state.insertion);
    state.records.turned.resize(model.graph.approaches.size());
    std::size_t expected = 0;
    for (const DemandPlan::Inlet& inlet : model.demand.inlets) {
        expected += static_cast<std::size_t>(std::min<std::int64_t>(inlet.vehicles, 2000));
    }
    if (model.records_all) state.records.passages.reserve(4 * expected);
    return state;
}

}  // namespace stopline
