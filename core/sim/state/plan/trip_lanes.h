// Computes, for each lane of each edge of a trip, how many lane changes the vehicle still needs. The best lane is the
// lane with the fewest lane changes. A vehicle that chooses the best lane early reaches the lane of its turn even if
// the edge before the intersection is short. Dynamic programming from the end of the trip gives two numbers of lane
// changes:
//
//     after(edge, lane): changes on later edges if the vehicle leaves the edge from `lane`. This is the minimum of
//         from(edge + 1, exit) over all exit lanes that the turn at the end of the edge reaches from `lane`.
//     from(edge, lane): changes on this edge and later ones if the vehicle begins the edge on `lane`. This is the
//         minimum of |lane - other| + after(edge, other) over all lanes of the edge.
//
// after() does not count lane changes on later edges of length kLongEdge_m or more, because a vehicle has enough time
// for lane changes there.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/state/model.h"

namespace stopline {

class NetworkPlan;

class TripLanes {
public:
    static constexpr int kNoConnection = 15;  // after(): the lane does not allow the turn at the end of the edge
    static constexpr double kLongEdge_m = 300.0;

    TripLanes() = default;
    TripLanes(const Model& model, const NetworkPlan& plan);

    // Return the numbers defined at the top of this file. after() returns 14 for 14 or more changes, 0 on the last edge
    // of the trip, and 0 for lanes from index kMaxLanes on. `edge` is counted along the trip from 0, `lane_index` from
    // the left.
    int after(const Trip& trip, int edge, int lane_index) const {
        if (edge >= trip.turn_count || lane_index >= kMaxLanes) return 0;
        const std::uint64_t packed = after_[static_cast<std::size_t>(trip.first_turn + edge)];
        return static_cast<int>((packed >> (4 * lane_index)) & 15U);
    }
    int from(const Trip& trip, int edge, int lane_index, int lane_count) const;

private:
    static constexpr int kMaxLanes = 16;
    void plan_trip(const Model& model, const NetworkPlan& plan, const Trip& trip);

    // [index in DemandPlan::trip_turns] after() of all lanes of the edge, four bits for each lane.
    std::vector<std::uint64_t> after_;
};

}  // namespace stopline
