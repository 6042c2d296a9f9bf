#include "sim/trip_lanes.h"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "sim/lane_plan.h"

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

}  // namespace

TripLanes::TripLanes(const Model& model, const NetworkPlan& plan) : after_(model.demand.trip_turns.size(), 0) {
    // Vehicles of a flow share their turns.
    std::vector<char> planned(after_.size(), 0);
    for (const Trip& trip : model.demand.trips) {
        if (trip.turns == 0 || planned[at(trip.first_turn)] != 0) continue;
        planned[at(trip.first_turn)] = 1;
        plan_trip(model, plan, trip);
    }
}

void TripLanes::plan_trip(const Model& model, const NetworkPlan& plan, const Trip& trip) {
    const LaneGraph& graph = model.graph;
    const auto turn_at = [&](int leg) { return model.demand.trip_turns[at(trip.first_turn + leg)]; };
    std::vector<int> approaches{trip.approach};
    for (int leg = 0; leg < trip.turns; ++leg) {
        const int route = plan.route_with(approaches.back(), turn_at(leg));
        approaches.push_back(graph.lanes[at(plan.route(route).back())].approach);
    }
    std::array<int, kPlaces> from{};  // of the edge that follows
    for (int leg = trip.turns - 1; leg >= 0; --leg) {
        const std::vector<int>& lanes = graph.approaches[at(approaches[at(leg)])].lanes;
        const int places = std::min(static_cast<int>(lanes.size()), kPlaces);
        std::uint64_t packed = 0;
        for (int place = 0; place < places; ++place) {
            int least = kNoWay;
            for (int way = plan.beside(lanes[at(place)]).way(turn_at(leg)).route; way >= 0; way = plan.like(way)) {
                const int onto = std::min(plan.beside(plan.route(way).back()).place, kPlaces - 1);
                least = std::min(least, std::min(from[at(onto)], kNoWay - 1));
            }
            packed |= static_cast<std::uint64_t>(least) << (4 * place);
        }
        after_[at(trip.first_turn + leg)] = packed;
        const bool is_long = graph.lanes[at(lanes[0])].stop_line_m >= kLongEdge_m;
        const int best = [&] {
            int least = kNoWay;
            for (int place = 0; place < places; ++place) least = std::min(least, after(trip, leg, place));
            return least;
        }();
        for (int place = 0; place < places; ++place) {
            from[at(place)] = is_long ? best : this->from(trip, leg, place, places);
        }
    }
}

int TripLanes::from(const Trip& trip, int leg, int place, int places) const {
    int least = kNoWay;
    for (int other = 0; other < std::min(places, kPlaces); ++other) {
        const int beyond = after(trip, leg, other);
        if (beyond != kNoWay) least = std::min(least, std::abs(place - other) + beyond);
    }
    return least;
}

}  // namespace stopline
