#include "sim/state/plan/network_plan.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>

#include "base/containers/index.h"
#include "base/simd/arithmetic.h"
#include "sim/state/state.h"

namespace stopline {

namespace {

// Disjoint sets of lanes (union-find). At the start, each lane is a set of its own.
class LaneSets {
public:
    explicit LaneSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }

    // Returns the lowest lane of the set that contains lane `member`.
    int of(int member) {
        while (parent_[at(member)] != member) {
            parent_[at(member)] = parent_[at(parent_[at(member)])];
            member = parent_[at(member)];
        }
        return member;
    }
    void join(int a, int b) {
        const int set_a = of(a);
        const int set_b = of(b);
        parent_[at(std::max(set_a, set_b))] = std::min(set_a, set_b);
    }

private:
    std::vector<int> parent_;
};

LanePlan plan_of(const Model& model, int index) {
    const Lane& lane = model.graph.lanes[at(index)];
    LanePlan plan;
    plan.length_m = lane.length_m;
    plan.stop_line_m = lane.stop_line_m;
    plan.next_limit_m = lane.signal_group >= 0 ? lane.stop_line_m : lane.length_m;
    plan.limit_mps = lane.limit_mps;
    plan.sine = static_cast<float>(lane.gradient / std::sqrt(1.0 + square(lane.gradient)));
    plan.signal_group = lane.signal_group;
    plan.origin = lane.origin;
    plan.branches = lane.next.size() > 1;
    if (lane.origin >= 0) plan.exit = lane.next[0];
    plan.keep_clear = lane.keep_clear;
    const auto has_signals = [&](int next) { return model.graph.lanes[at(next)].movement_signal_group >= 0; };
    plan.has_movement_signals = lane.origin < 0 && std::any_of(lane.next.begin(), lane.next.end(), has_signals);
    for (const Conflict& conflict : model.graph.conflicts_of(index)) {
        plan.first_conflict_m = std::min(plan.first_conflict_m, conflict.from_m);
        plan.yields = plan.yields || conflict.yields;
    }
    return plan;
}

// Returns the entry speed of each lane (NetworkPlan::entry_speed_mps()). Braking for a lower limit can begin several
// lanes upstream, so the computation is repeated until no speed changes.
LargeArray<double> entry_speeds_mps(const LaneGraph& graph, std::span<const LanePlan> lanes, double braking_mps2) {
    LargeArray<double> entry_mps;
    for (const LanePlan& lane : lanes) entry_mps.push_back(lane.limit_mps);
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t lane = 0; lane < lanes.size(); ++lane) {
            if (graph.lanes[lane].next.empty()) continue;
            double next_mps = 0.0;
            for (const int next : graph.lanes[lane].next) next_mps = std::max(next_mps, entry_mps[at(next)]);
            const double reached_mps = std::sqrt(square(next_mps) + 2.0 * braking_mps2 * lanes[lane].next_limit_m);
            if (reached_mps >= entry_mps[lane]) continue;
            entry_mps[lane] = reached_mps;
            changed = true;
        }
    }
    return entry_mps;
}

double longest_vehicle_m(const Model& model) {
    double longest_m = 0.0;
    for (const PowertrainTables& type : model.vehicles) longest_m = std::max(longest_m, type.length_m);
    for (const Trip& trip : model.demand.trips) longest_m = std::max(longest_m, static_cast<double>(trip.length_m));
    return longest_m;
}

double max_space_per_vehicle(const Model& model) {
    double gap_m = 0.0;
    for (const GapPolicy& policy : model.policies) gap_m = std::max(gap_m, policy.settings.standstill_gap_m);
    return longest_vehicle_m(model) + gap_m;
}

// Joins the lanes of each intersection to one set: the lanes of its approaches, its connections, and its exit lanes
// without a stop line. These exit lanes join the set only so that the data of the intersection are close together in
// memory.
void join_intersections(const Model& model, LaneSets& sets) {
    for (int index = 0; index < static_cast<int>(model.graph.lanes.size()); ++index) {
        const Lane& lane = model.graph.lanes[at(index)];
        if (lane.origin < 0) continue;
        sets.join(index, lane.origin);
        for (const Conflict& conflict : model.graph.conflicts_of(index)) sets.join(index, conflict.other);
        if (model.graph.lanes[at(lane.next[0])].signal_group < 0) sets.join(index, lane.next[0]);
    }
    for (const Approach& approach : model.graph.approaches) {
        for (const int lane : approach.lanes) sets.join(approach.lanes[0], lane);
    }
}

}  // namespace

// Sets TurnOption::lane_changes of one turn for each lane of an approach.
void NetworkPlan::count_lane_changes(const Approach& approach, std::size_t turn) {
    const auto lanes = static_cast<int>(approach.lanes.size());
    const auto option = [&](int k) -> TurnOption& { return adjacent_of(approach.lanes[at(k)]).turn_options[turn]; };
    for (int k = 0; k < lanes; ++k) {
        for (int distance = 0; distance < lanes && option(k).route < 0 && option(k).lane_changes == 0; ++distance) {
            if (k + distance < lanes && option(k + distance).route >= 0) {
                option(k).lane_changes = distance;
            } else if (k >= distance && option(k - distance).route >= 0) {
                option(k).lane_changes = -distance;
            }
        }
    }
}

// Sets the neighbours and turn options of all lanes. Routes with the same first lane and the same turn form a list, in
// descending order of their indices. TurnOption::route gets the first route of the list.
void NetworkPlan::plan_adjacent_lanes(const LaneGraph& graph) {
    std::vector<bool> has_entry(graph.lanes.size());
    for (std::size_t lane = 0; lane < graph.lanes.size(); ++lane) {
        const Lane& own = graph.lanes[lane];
        has_entry[lane] = own.approach >= 0 || own.left >= 0 || own.right >= 0 || own.start_offset_m != 0.0;
    }
    for (const Route& route : graph.routes) has_entry[at(route.lanes[0])] = true;
    for (const Approach& approach : graph.approaches) {
        for (const int lane : approach.lanes) has_entry[at(lane)] = true;
    }
    const auto entries = static_cast<std::size_t>(std::count(has_entry.begin(), has_entry.end(), true));
    adjacent_.reserve(entries + 1);
    adjacent_.resize(1);
    adjacent_index_.assign(graph.lanes.size(), 0);
    for (std::size_t lane = 0; lane < graph.lanes.size(); ++lane) {
        if (!has_entry[lane]) continue;
        adjacent_index_[lane] = static_cast<int>(adjacent_.size());
        AdjacentLanes& entry = adjacent_.emplace_back();
        entry.left = graph.lanes[lane].left;
        entry.right = graph.lanes[lane].right;
        entry.start_offset_m = graph.lanes[lane].start_offset_m;
    }
    for (std::size_t route = 0; route < graph.routes.size(); ++route) {
        AdjacentLanes& origin = adjacent_of(graph.routes[route].lanes[0]);
        int& first_route = origin.turn_options[static_cast<std::size_t>(turns_[route])].route;
        next_parallel_route_.push_back(first_route);
        first_route = static_cast<int>(route);
    }
    for (const Approach& approach : graph.approaches) {
        for (std::size_t k = 0; k < approach.lanes.size(); ++k) {
            adjacent_of(approach.lanes[k]).index = static_cast<int>(k);
        }
        for (std::size_t turn = 0; turn < static_cast<std::size_t>(kMaxTurns); ++turn) {
            count_lane_changes(approach, turn);
        }
    }
}

// Right of way changes only in runs with changing priorities. All other runs read the areas of the model.
void NetworkPlan::list_conflicts(const Model& model) {
    const bool changes = !model.phase_priorities.empty() || !model.priorities_by_phase.empty();
    if (!changes && !model.graph.conflicts.empty()) {
        model_conflicts_ = &model.graph.conflicts;
        return;
    }
    const auto lanes = static_cast<int>(model.graph.lanes.size());
    for (int lane = 0; lane < lanes; ++lane) own_conflicts_.add(model.graph.conflicts_of(lane));
}

NetworkPlan::NetworkPlan(const Model& model)
    : speed_factor_(model.speed_factor),
      max_space_per_vehicle_m_(max_space_per_vehicle(model)),
      demand_(&model.demand) {
    if (model.has_speed_limiters) {
        for (int policy = 0; policy < static_cast<int>(model.classes.size()); ++policy) {
            maximum_speeds_mps_.push_back(model.vehicle_of(policy).maximum_speed_mps);
        }
    }
    const auto count = static_cast<int>(model.graph.lanes.size());
    const double longest_m = longest_vehicle_m(model);
    LaneSets sets(at(count));
    join_intersections(model, sets);
    lanes_.reserve(at(count)), intersection_of_.reserve(at(count)), lane_order_.reserve(at(count));
    may_wait_inside_.reserve(at(count)), stop_rules_.reserve(at(count)), movement_groups_.reserve(at(count));
    diverges_.reserve(at(count));
    for (int index = 0; index < count; ++index) {
        const Lane& lane = model.graph.lanes[at(index)];
        lanes_.push_back(plan_of(model, index));
        intersection_of_.push_back(sets.of(index));
        intersection_count_ += sets.of(index) == index ? 1 : 0;
        lane_order_.push_back(index);
        may_wait_inside_.push_back(lane.waits_inside ? 1 : 0);
        stop_rules_.push_back(lane.stop_rule);
        movement_groups_.push_back(lane.movement_signal_group);
        diverges_.push_back({lane.diverge_end_m, lane.origin >= 0 && lane.length_m - lane.diverge_end_m < longest_m,
                             !lane.diverge_ends_m.empty()});
        diverge_ends_.add(lane.diverge_ends_m);
        next_.add(lane.next);
    }
    for (int lane = 0; lane < count; ++lane) {
        if (!diverge_ends_differ(lane)) continue;
        int index = 0;
        for (const int connection : next(lane)) diverges_[at(connection)].index = index++;
    }
    has_short_exits_ =
        std::ranges::any_of(lanes_, [this](const LanePlan& lane) { return lane.exit >= 0 && is_short(lane.exit); });
    list_conflicts(model);
    std::stable_sort(lane_order_.begin(), lane_order_.end(),
                     [this](int a, int b) { return intersection_of(a) < intersection_of(b); });
    for (const PhasePriority& changing : model.phase_priorities) {
        for (const PriorityStage& stage : changing.stages()) {
            lanes_[at(changing.first())].yields |= stage.priority.first_yields;
            lanes_[at(changing.second())].yields |= stage.priority.second_yields;
        }
    }
    for (const PriorityByPhase& changing : model.priorities_by_phase) {
        for (const std::optional<Priority>& priority : changing.by_phase) {
            lanes_[at(changing.first)].yields |= priority && priority->first_yields;
            lanes_[at(changing.second)].yields |= priority && priority->second_yields;
        }
    }
    number_connections(model);
    for (const Route& route : model.graph.routes) {
        routes_.add(route.lanes);
        turns_.push_back(route.lanes.size() > 1 ? model.graph.lanes[at(route.lanes[1])].turn : Turn::none);
    }
    double braking_mps2 = model.common_driver().deceleration_mps2;
    for (const DriverPlan& driver : model.drivers)
        braking_mps2 = std::min(braking_mps2, driver.tables.deceleration_mps2);
    entry_speed_mps_ = entry_speeds_mps(model.graph, lanes_, braking_mps2);
    plan_adjacent_lanes(model.graph);
    for (const Approach& approach : model.graph.approaches) {
        std::array<int, kMaxTurns> routes{};
        routes.fill(-1);
        for (const int lane : approach.lanes) {
            for (std::size_t turn = 0; turn < routes.size(); ++turn) {
                routes[turn] = std::max(routes[turn], adjacent(lane).turn_options[turn].route);
            }
        }
        routes_with_.push_back(routes);
    }
    for (const int lane : lane_order_) {
        if (adjacent(lane).has_neighbours()) lanes_with_neighbours_.push_back(lane);
    }
    if (!model.demand.trips.empty()) trip_lanes_ = TripLanes(model, *this);
}

void NetworkPlan::set_priority(int first, int second, Priority priority) {
    const auto set = [&](int lane, int other, bool yields, bool other_yields) {
        for (Conflict& conflict : own_conflicts_.of(lane)) {
            if (conflict.other != other) continue;
            conflict.yields = yields;
            conflict.other_yields = other_yields;
        }
    };
    set(first, second, priority.first_yields, priority.second_yields);
    set(second, first, priority.second_yields, priority.first_yields);
}

void NetworkPlan::number_connections(const Model& model) {
    constexpr std::size_t kBits = Bitset::kWordBits;
    int intersection = -1;
    for (const int lane : lane_order_) {
        if (lanes_[at(lane)].origin < 0 || model.graph.conflicts_of(lane).empty()) continue;
        if (intersection_of(lane) != intersection) {
            connections_.resize((connections_.size() + kBits - 1) / kBits * kBits, -1);
            intersection = intersection_of(lane);
        }
        lanes_[at(lane)].bitset_index = static_cast<int>(connections_.size());
        connections_.push_back(lane);
    }
    for (std::size_t lane = 0; lane < lanes_.size(); ++lane) {
        std::vector<BitsetMask> masks;
        for (const Conflict& conflict : model.graph.conflicts_of(static_cast<int>(lane))) {
            const int index = lanes_[at(conflict.other)].bitset_index;
            if (index < 0) continue;
            const std::size_t word = at(index) / kBits;
            auto mask = std::find_if(masks.begin(), masks.end(), [&](const BitsetMask& m) { return m.word == word; });
            if (mask == masks.end()) mask = masks.insert(mask, {word, 0});
            mask->bits |= std::uint64_t{1} << at(index) % kBits;
        }
        conflicting_.add(masks);
    }
}

}  // namespace stopline
