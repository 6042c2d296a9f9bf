// Imported networks in the reference engine: a vehicle brakes before a short approach lane. The rules are those of the
// comments in core/sim/junction/short_approaches.h.
#pragma once

#include "reference/demand.h"
#include "reference/junction/stop_lines.h"

namespace stopline::reference_engine {

class ShortApproaches {
public:
    ShortApproaches(World& world, const Routes& routes) : w_(world), routes_(routes), stop_lines_(world) {}

    // Adds the yield stops of vehicles upstream of their next approach lane. Call it after right of way is decided.
    void add_stops() {
        if (!w_.is_imported) return;
        for (Lane& lane : w_.lanes) {
            for (const Vehicle& v : lane.vehicles) {
                if (v.speed_mps < kStoppedSpeed_mps) continue;
                if (lane.length_m - v.position_m > decision_distance_m(w_.driver(v), v.speed_mps)) break;
                const double place_m = stop_m(lane, v);
                if (place_m == kNoLimit) continue;
                lane.add_yield_stop({v.index, place_m, -1, WaitReason::priority});
                ++w_.situations.stops_beyond_lane;
            }
        }
    }

private:
    // Returns the nearest position on the later approach lanes of its trip where the vehicle must be able to stop, from
    // the start of its lane; infinity: none within the decision distance.
    double stop_m(const Lane& lane, const Vehicle& v) const {
        if (v.trip < 0 || v.next_lane < 0) return kNoLimit;
        const double last_m = v.position_m + decision_distance_m(w_.driver(v), v.speed_mps);
        std::vector<int> route = w_.route_of(v.route);
        auto next = static_cast<std::size_t>(v.route_index) + 1;
        double start_m = lane.length_m;
        for (int edge = v.trip_edge + 1; start_m <= last_m; ++edge) {
            for (; next + 1 < route.size(); ++next) start_m += w_.lane(route[next]).length_m;
            const Lane& approach = w_.lane(route.back());
            const Turn turn = w_.model.demand.turn_of_trip(v.trip, edge);
            if (start_m > last_m || turn == Turn::none) return kNoLimit;
            const std::vector<int>& choices = routes_.routes_on(approach.number, turn);
            if (choices.empty()) return kNoLimit;
            double nearest_m = kNoLimit;
            for (const int choice : choices)
                nearest_m =
                    std::min(nearest_m, stop_on_approach_m(v, approach, w_.lane(w_.route_of(choice)[1]), start_m));
            if (start_m + nearest_m <= last_m) return start_m + nearest_m;
            start_m += approach.length_m;
            route = w_.route_of(choices.front());
            next = 1;
        }
        return kNoLimit;
    }

    // Returns the first position on an approach lane where the vehicle must be able to stop if it takes the connection;
    // infinity: none. `start_m`: start of the approach lane, from the start of the vehicle's lane.
    double stop_on_approach_m(const Vehicle& v, const Lane& approach, const Lane& connection, double start_m) const {
        const DriverSettings& driver = w_.driver(v);
        const double line_m = approach.stop_line_m - driver.stop.margin_m;
        const auto on_lane_m = [](double wait_m, double end_m) { return std::max({wait_m, 0.5 * end_m, 0.05}); };
        bool stops_at_line = connection.stop_rule != StopRule::none;
        if (approach.signal_group >= 0) {
            const Light light = w_.light(w_.group_of(approach, connection.number));
            stops_at_line = stops_at_line || (light != Light::green &&
                                              stop_lines_.can_stop_for(v, light, start_m + approach.stop_line_m));
        }
        if (stops_at_line) return on_lane_m(line_m, approach.stop_line_m);
        for (const Conflict& conflict : connection.conflicts) {
            if (!conflict.yields && !is_occupied(conflict)) continue;
            const double area_m = approach.length_m + conflict.from_m;
            const double before_m = area_m - driver.give_way.margin_m;
            return on_lane_m(connection.waits_inside ? before_m : std::min(before_m, line_m), area_m);
        }
        return kNoLimit;
    }

    // Returns true if a vehicle that takes the other connection is in the conflict area.
    bool is_occupied(const Conflict& conflict) const {
        const Lane& other = w_.lane(conflict.other);
        const auto has_vehicle_in_area = [&](const Lane& lane, double offset_m, const auto& takes_other) {
            return std::any_of(lane.vehicles.begin(), lane.vehicles.end(), [&](const Vehicle& v) {
                return takes_other(v) && v.position_m + offset_m > conflict.other_from_m &&
                       v.rear_m() + offset_m < conflict.other_to_m;
            });
        };
        const Lane& origin = w_.lane(other.origin);
        return has_vehicle_in_area(other, 0.0, [](const Vehicle&) { return true; }) ||
               has_vehicle_in_area(origin, -origin.length_m,
                                   [&](const Vehicle& v) { return v.next_lane == other.number; }) ||
               has_vehicle_in_area(w_.lane(other.exit), other.length_m,
                                   [&](const Vehicle& v) { return v.previous_lane == other.number; });
    }

    World& w_;
    const Routes& routes_;
    StopLines stop_lines_;
};

}  // namespace stopline::reference_engine
