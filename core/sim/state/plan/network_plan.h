// The network in the layout that the phases of a step read. The data of a lane fill one cache line, and all routes lie
// in one array. Lanes are ordered by intersection, because threads share the work by whole intersections.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "base/containers/bitset.h"
#include "base/containers/packed_lists.h"
#include "base/simd/huge_page_allocator.h"
#include "base/simd/simd.h"
#include "sim/state/model.h"
#include "sim/state/plan/lane_plan.h"
#include "sim/state/plan/trip_lanes.h"

namespace stopline {

class NetworkPlan {
public:
    // The plan refers to the demand and the conflict areas of the model, so the model must outlive the plan.
    explicit NetworkPlan(const Model& model);

    const LanePlan& lane(int lane) const { return lanes_[static_cast<std::size_t>(lane)]; }
    int lanes() const { return static_cast<int>(lanes_.size()); }
    // Returns the length of the longest vehicle plus the largest standstill gap, m.
    double max_space_per_vehicle_m() const { return max_space_per_vehicle_m_; }
    // Returns true if the lane, up to its stop line, is shorter than kFewVehicles times max_space_per_vehicle_m().
    bool is_short(int lane) const { return this->lane(lane).next_limit_m < kFewVehicles * max_space_per_vehicle_m_; }
    // Returns true if at least one exit lane of the network is short.
    bool has_short_exits() const { return has_short_exits_; }
    // Returns the speed limit of a lane times Model::speed_factor.
    double free_speed_mps(int lane) const { return speed_factor_ * this->lane(lane).limit_mps; }
    // Returns the same, but at most the maximum speed of the vehicles with this spacing policy (their speed limiter).
    double free_speed_mps(int lane, int policy) const {
        return maximum_speeds_mps_.empty()
                   ? free_speed_mps(lane)
                   : std::min(free_speed_mps(lane), maximum_speeds_mps_[static_cast<std::size_t>(policy)]);
    }
    // Returns the highest speed at which a vehicle may enter a lane. From this speed, braking with
    // DriverTables::deceleration_mps2 suffices for all lower limits further downstream. Where a lane branches, the
    // following lane with the highest entry speed counts.
    double entry_speed_mps(int lane) const { return entry_speed_mps_[static_cast<std::size_t>(lane)]; }
    std::span<const int> route(int route) const { return routes_.of(route); }
    std::span<const int> next(int lane) const { return next_.of(lane); }
    const AdjacentLanes& adjacent(int lane) const {
        return adjacent_[static_cast<std::size_t>(adjacent_index_[static_cast<std::size_t>(lane)])];
    }
    const std::vector<int>& lanes_with_neighbours() const { return lanes_with_neighbours_; }
    // Returns the index of a route with this turn that begins on any lane of the approach; -1: none.
    int route_with(int approach, Turn turn) const {
        return routes_with_[static_cast<std::size_t>(approach)][static_cast<std::size_t>(turn)];
    }
    Turn turn_of(int route) const { return turns_[static_cast<std::size_t>(route)]; }
    // Routes with the same first lane and the same turn, but with different exit lanes, form a list. Returns the route
    // that follows `route` in this list; -1: none.
    int next_parallel_route(int route) const { return next_parallel_route_[static_cast<std::size_t>(route)]; }
    // Returns the signal group that a vehicle on an approach lane obeys. `next`: connection that the vehicle will take;
    // -1: none.
    int signal_group_for(int lane, int next) const {
        const LanePlan& plan = this->lane(lane);
        const int own = plan.has_movement_signals && next >= 0 ? movement_groups_[static_cast<std::size_t>(next)] : -1;
        return own >= 0 ? own : plan.signal_group;
    }
    // Returns the position on a connection from which the connection lies apart from the other connections of the same
    // approach lane. A vehicle whose rear is past this position is clear of these other connections.
    double diverge_end_m(int lane) const { return diverges_[static_cast<std::size_t>(lane)].end_m; }
    // Returns the same position for a single other connection. `other`: this connection, which begins on the same
    // approach lane; -1: unknown, so the result holds for all.
    double diverge_end_m(int lane, int other) const {
        const DivergePlan& plan = diverges_[static_cast<std::size_t>(lane)];
        if (!plan.differs || other < 0) return plan.end_m;
        return diverge_ends_.of(lane)[static_cast<std::size_t>(diverges_[static_cast<std::size_t>(other)].index)];
    }
    // Returns true if the connections of an approach lane diverge from each other at different positions.
    bool diverge_ends_differ(int lane) const {
        return !next(lane).empty() && diverges_[static_cast<std::size_t>(next(lane)[0])].differs;
    }
    // Returns true if a vehicle with its front on the exit lane of a connection can still have its rear upstream of
    // diverge_end_m() of this connection.
    bool exit_reaches_back(int lane) const { return diverges_[static_cast<std::size_t>(lane)].exit_reaches_back; }
    // Returns true if vehicles on this connection may yield inside the intersection. Otherwise they yield at the stop
    // line.
    bool may_wait_inside(int lane) const { return may_wait_inside_[static_cast<std::size_t>(lane)] != 0; }
    // Returns what vehicles on the way to a connection must do at the stop line.
    StopRule stop_rule(int lane) const { return stop_rules_[static_cast<std::size_t>(lane)]; }
    // Returns the turn of a trip at the end of one of its edges, or Turn::none if the trip ends on this edge.
    Turn turn_of_trip(int trip, int trip_edge) const { return demand_->turn_of_trip(trip, trip_edge); }
    // Returns the number of lane changes that a trip needs on the edges after edge `trip_edge` if the vehicle leaves
    // edge `trip_edge` from `lane`.
    int lane_changes_after(int trip, int trip_edge, int lane) const {
        return trip_lanes_.after(demand_->trips[static_cast<std::size_t>(trip)], trip_edge, adjacent(lane).index);
    }
    // Returns the number of lane changes that a trip needs on edge `trip_edge` and on later edges if the vehicle begins
    // edge `trip_edge` on `lane`. `lanes`: number of lanes of this edge.
    int lane_changes_from(int trip, int trip_edge, int lane, int lanes) const {
        return trip_lanes_.from(demand_->trips[static_cast<std::size_t>(trip)], trip_edge, adjacent(lane).index, lanes);
    }
    STOPLINE_INLINE void prefetch_conflicts(int lane) const {
        for (const Conflict& conflict : conflicts(lane)) __builtin_prefetch(&conflict);
    }
    // Returns the conflict areas of a connection, in the order from its start to its end.
    std::span<const Conflict> conflicts(int lane) const {
        if (model_conflicts_ == nullptr) return own_conflicts_.of(lane);
        return (*model_conflicts_)[static_cast<std::size_t>(lane)];
    }
    // Sets which of two connections yields at their conflict area. Right of way can change with the phases of a signal.
    // All other data of the plan are constant during a run.
    void set_priority(int first, int second, Priority priority);
    // Returns the connections that share a conflict area with connection `lane`, as masks for the bitsets of
    // JunctionState.
    std::span<const BitsetMask> conflicting(int lane) const { return conflicting_.of(lane); }
    // The bitsets of JunctionState have one bit for each connection with conflict areas, in the order of lane_order().
    // No two intersections share a word of a bitset, so that no two threads write the same word. Therefore, some bits
    // are unused.
    std::size_t bitset_size() const { return connections_.size(); }
    int connection_at(std::size_t bitset_index) const {
        return connections_[bitset_index];  // -1: the bit is unused
    }
    // Calls visit(begin, end) for the ranges of memory that are prefetched for this lane (sim/performance/prefetch.h).
    template <class Visit>
    void for_each_memory_range(int lane, Visit visit) const {
        const auto element = [&](const auto& array) { visit(array.data() + lane, array.data() + lane + 1); };
        element(lanes_), element(diverges_), element(movement_groups_), element(may_wait_inside_), element(stop_rules_);
        next_.visit_memory(lane, visit), conflicting_.visit_memory(lane, visit);
        if (diverges_[static_cast<std::size_t>(lane)].differs) diverge_ends_.visit_memory(lane, visit);
        model_conflicts_ == nullptr ? own_conflicts_.visit_offsets(lane, visit) : element(*model_conflicts_);
        if (adjacent_index_[static_cast<std::size_t>(lane)] == 0) return;
        for (const TurnOption& option : adjacent(lane).turn_options) {
            if (option.route >= 0) routes_.visit_memory(option.route, visit);
        }
    }
    // Returns all lanes, grouped by intersection.
    const LargeArray<int>& lane_order() const { return lane_order_; }
    int intersection_count() const { return intersection_count_; }
    // Returns the intersection number of a lane. Lanes with the same number are in the same partition, so one
    // thread processes them.
    int intersection_of(int lane) const { return intersection_of_[static_cast<std::size_t>(lane)]; }

private:
    AdjacentLanes& adjacent_of(int lane) {
        return adjacent_[static_cast<std::size_t>(adjacent_index_[static_cast<std::size_t>(lane)])];
    }
    void plan_adjacent_lanes(const LaneGraph& graph);
    void count_lane_changes(const Approach& approach, std::size_t turn);
    void list_conflicts(const Model& model);
    void number_connections(const Model& model);

    double speed_factor_;
    static constexpr double kFewVehicles = 3.0;  // our choice
    double max_space_per_vehicle_m_ = 0.0;
    bool has_short_exits_ = false;
    int intersection_count_ = 0;
    LargeArray<LanePlan> lanes_;
    LargeArray<double> entry_speed_mps_;      // [lane]
    std::vector<double> maximum_speeds_mps_;  // [spacing policy]; empty: no speed limiter is below a speed limit
    PackedLists<int> routes_;
    PackedLists<int> next_;
    // [lane] conflict areas of the model; nullptr: right of way changes during the run, so the plan has its own areas
    const std::vector<std::vector<Conflict>>* model_conflicts_ = nullptr;
    PackedLists<Conflict> own_conflicts_;
    PackedLists<BitsetMask> conflicting_;
    LargeArray<int> connections_;  // [bitset index] connection with this index; -1: unused
    LargeArray<int> lane_order_;
    LargeArray<int> intersection_of_;     // [lane]
    LargeArray<int> adjacent_index_;      // [lane] index in adjacent_
    LargeArray<AdjacentLanes> adjacent_;  // the first element is for all lanes without routes and neighbours
    std::vector<int> lanes_with_neighbours_;
    LargeArray<Turn> turns_;                              // [route]
    LargeArray<std::array<int, kMaxTurns>> routes_with_;  // [approach][turn] index of a route; -1: none
    LargeArray<int> next_parallel_route_;                 // [route]
    LargeArray<int> movement_groups_;   // [lane] signal group of the movement of a connection; -1: none
    LargeArray<char> may_wait_inside_;  // [lane]
    LargeArray<StopRule> stop_rules_;   // [lane]
    struct DivergePlan {
        double end_m = 0.0;
        bool exit_reaches_back = false;
        bool differs = false;  // diverge_ends_ has a list for the connection
        int index = 0;         // of the connection, among those of its approach lane
    };
    LargeArray<DivergePlan> diverges_;  // [lane]
    PackedLists<double> diverge_ends_;  // [lane] Lane::diverge_ends_m
    const DemandPlan* demand_;
    TripLanes trip_lanes_;
};

}  // namespace stopline
