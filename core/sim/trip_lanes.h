// Which lane of each edge of a trip leads on with fewest changes of lanes on the edges that follow, so that a vehicle is in the lane of
// its turn although the edge before the intersection is short. Computed once for each trip, from its end (dynamic programming):
//
//     after(leg, lane)  = least of from(leg + 1, lane it leads to), over its connections with the turn of that leg
//     from(leg, lane)   = least of |lane - other| + after(leg, other), over all lanes of the edge
//
// Changes on an edge of kLongEdge_m or more count nothing: there is time for them.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/model.h"

namespace stopline {

class NetworkPlan;

class TripLanes {
public:
    static constexpr int kNoWay = 15;  // the lane does not lead on with the turn of that leg
    static constexpr double kLongEdge_m = 300.0;

    TripLanes() = default;
    TripLanes(const Model& model, const NetworkPlan& plan);

    // By place of the lane on its edge, counted from the left; 14 stands for more. 0 at the end of the trip.
    int after(const Trip& trip, int leg, int place) const {
        if (leg >= trip.turns || place >= kPlaces) return 0;
        const std::uint64_t packed = after_[static_cast<std::size_t>(trip.first_turn + leg)];
        return static_cast<int>((packed >> (4 * place)) & 15U);
    }
    // `places`: lanes of the edge.
    int from(const Trip& trip, int leg, int place, int places) const;

private:
    static constexpr int kPlaces = 16;
    void plan_trip(const Model& model, const NetworkPlan& plan, const Trip& trip);

    std::vector<std::uint64_t> after_;  // as DemandPlan::trip_turns
};

}  // namespace stopline
