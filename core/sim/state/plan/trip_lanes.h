// The best lane on each edge of a trip: the lane with the fewest lane changes on the edges that follow. A vehicle thus
// reaches the lane of its turn even if the edge before the intersection is short. Dynamic programming from the end:
//
//     after(edge, lane) = min of from(edge + 1, lane it leads to), over its connections with the turn of that edge
//     from(edge, lane)  = min of |lane - other| + after(edge, other), over all lanes of the edge
//
// Lane changes on an edge of kLongEdge_m or more are not counted, since there is time for them.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/state/model.h"

namespace stopline {

class NetworkPlan;

class TripLanes {
public:
    static constexpr int kNoConnection = 15;  // the lane has no connection with the turn of that edge
    static constexpr double kLongEdge_m = 300.0;

    TripLanes() = default;
    TripLanes(const Model& model, const NetworkPlan& plan);

    // Return lane changes, 14 for 14 and more. Edges are counted along the trip, lanes from the left.
    int after(const Trip& trip, int edge, int lane_index) const {
        if (edge >= trip.turn_count || lane_index >= kMaxLanes) return 0;
        const std::uint64_t packed = after_[static_cast<std::size_t>(trip.first_turn + edge)];
        return static_cast<int>((packed >> (4 * lane_index)) & 15U);
    }
    int from(const Trip& trip, int edge, int lane_index, int lane_count) const;

private:
    static constexpr int kMaxLanes = 16;
    void plan_trip(const Model& model, const NetworkPlan& plan, const Trip& trip);

    std::vector<std::uint64_t> after_;  // [index in DemandPlan::trip_turns] four bits a lane
};

}  // namespace stopline
