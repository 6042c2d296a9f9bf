#include "sim/state/plan/trip_lanes.h"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "base/containers/index.h"
#include "sim/state/plan/network_plan.h"
#include "sim/state/state.h"

namespace stopline {

TripLanes::TripLanes(const Model& model, const NetworkPlan& plan) : after_(model.demand.trip_turns.size(), 0) {
    // Trips along the same route share their entries of trip_turns, and therefore the entries of after_ with the same
    // indices. The entries are computed only for the first of these trips.
    std::vector<char> planned(after_.size(), 0);
    for (const Trip& trip : model.demand.trips) {
        if (trip.turn_count == 0 || planned[at(trip.first_turn)] != 0) continue;
        planned[at(trip.first_turn)] = 1;
        plan_trip(model, plan, trip);
    }
}

void TripLanes::plan_trip(const Model& model, const NetworkPlan& plan, const Trip& trip) {
    const LaneGraph& graph = model.graph;
    const auto turn_at = [&](int edge) { return model.demand.trip_turns[at(trip.first_turn + edge)]; };
    std::vector<int> approaches{trip.approach};
    for (int edge = 0; edge < trip.turn_count; ++edge) {
        const int route = plan.route_with(approaches.back(), turn_at(edge));
        approaches.push_back(graph.lanes[at(plan.route(route).back())].approach);
    }
    // [lane index] Fewest lane changes for the rest of the trip if the vehicle begins the next edge on this lane.
    // Changes on a long edge are not counted.
    std::array<int, kMaxLanes> from_next{};
    for (int edge = trip.turn_count - 1; edge >= 0; --edge) {
        const std::vector<int>& lanes = graph.approaches[at(approaches[at(edge)])].lanes;
        const int count = std::min(static_cast<int>(lanes.size()), kMaxLanes);
        std::uint64_t packed = 0;
        for (int index = 0; index < count; ++index) {
            int fewest = kNoConnection;
            for (int route = plan.adjacent(lanes[at(index)]).turn_option(turn_at(edge)).route; route >= 0;
                 route = plan.next_parallel_route(route)) {
                const int target = std::min(plan.adjacent(plan.route(route).back()).index, kMaxLanes - 1);
                fewest = std::min(fewest, std::min(from_next[at(target)], kNoConnection - 1));
            }
            packed |= static_cast<std::uint64_t>(fewest) << (4 * index);
        }
        after_[at(trip.first_turn + edge)] = packed;
        const bool is_long = graph.lanes[at(lanes[0])].stop_line_m >= kLongEdge_m;
        int fewest_of_edge = kNoConnection;
        for (int index = 0; index < count; ++index) {
            fewest_of_edge = std::min(fewest_of_edge, after(trip, edge, index));
        }
        for (int index = 0; index < count; ++index) {
            from_next[at(index)] = is_long ? fewest_of_edge : from(trip, edge, index, count);
        }
    }
}

int TripLanes::from(const Trip& trip, int edge, int lane_index, int lane_count) const {
    int fewest = kNoConnection;
    for (int other = 0; other < std::min(lane_count, kMaxLanes); ++other) {
        const int beyond = after(trip, edge, other);
        if (beyond != kNoConnection) fewest = std::min(fewest, std::abs(lane_index - other) + beyond);
    }
    return fewest;
}

}  // namespace stopline
