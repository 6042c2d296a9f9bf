// Vehicles that enter on trips of SUMO in the reference engine. The rules are those of the comments in
// core/sim/insertion/trips.cpp.
#pragma once

#include "reference/insertion/insertion.h"

namespace stopline::reference_engine {

class TripInsertion {
public:
    TripInsertion(World& world, Routes& routes, Entrance& entrance)
        : w_(world),
          routes_(routes),
          entrance_(entrance),
          perception_(world),
          waiting_(world.is_imported ? world.model.graph.approaches.size() : 0) {}

    // Inserts the vehicles that are due, as far as there is room. On each approach, the vehicles enter in the order of
    // their departures. A vehicle without room blocks the later vehicles of its lane.
    void insert_due() {
        const double now_s = static_cast<double>(w_.tick + 1) * w_.step_s;
        const std::vector<Trip>& trips = w_.model.demand.trips;
        for (; next_ < trips.size() && trips[next_].depart_s < now_s; ++next_)
            waiting_[static_cast<std::size_t>(trips[next_].approach)].push_back(static_cast<int>(next_));
        for (std::vector<int>& of_approach : waiting_) {
            std::vector<int> full_lanes;
            std::vector<int> left;
            for (const int trip : of_approach) {
                w_.number_vehicles();
                const Point point = point_of(trip);
                const bool is_full = std::find(full_lanes.begin(), full_lanes.end(), point.lane) != full_lanes.end();
                if (!is_full && insert(trip, point)) continue;
                full_lanes.push_back(point.lane);
                left.push_back(trip);
                w_.situations.entered_late += is_full || trip == last_late_ ? 0 : 1;
                last_late_ = trip;
            }
            of_approach = left;
        }
    }

private:
    static constexpr double kRounding_m = 0.01;

    // Where a vehicle is to enter.
    struct Point {
        int lane = -1;
        std::size_t index = 0;  // number of vehicles ahead
        double front_m = 0.0;
    };

    const Trip& trip_of(int number) const { return w_.model.demand.trips[static_cast<std::size_t>(number)]; }
    int policy_of(int number) const { return w_.model.demand.trip_policies[static_cast<std::size_t>(number)]; }
    double drawn(int number, std::uint64_t n) const {
        return random_uniform(w_.scenario.seed, static_cast<std::uint64_t>(number), n, Purpose::insertion);
    }

    int departure_lane(int number) const {
        const Trip& trip = trip_of(number);
        const std::vector<int>& lanes = w_.model.graph.approaches[static_cast<std::size_t>(trip.approach)].lanes;
        const auto count = static_cast<int>(lanes.size());
        using enum Trip::DepartLane;
        if (trip.depart_lane == given) return lanes[static_cast<std::size_t>(std::min(trip.lane, count - 1))];
        if (trip.depart_lane == rightmost) return lanes.back();
        if (trip.depart_lane == random)
            return lanes[static_cast<std::size_t>(std::min(static_cast<int>(drawn(number, 0) * count), count - 1))];
        // The best lane needs the fewest lane changes. Among equal lanes, the one with the longest free part is chosen.
        const auto rank = [&](int lane) {
            const int changes = trip.depart_lane == best ? routes_.trip_changes_from(number, 0, lane, false) : 0;
            const Lane& on = w_.lane(lane);
            return std::pair(changes, on.vehicles.empty() ? -1e6 : -on.vehicles.back().rear_m());
        };
        int chosen = lanes.back();
        for (auto lane = lanes.rbegin(); lane != lanes.rend(); ++lane) {
            if (rank(*lane) < rank(chosen)) chosen = *lane;
        }
        return chosen;
    }

    Point point_of(int number) const {
        const Lane& on = w_.lane(departure_lane(number));
        Point point{on.number, on.vehicles.size(), front_m(on, number)};
        while (point.index > 0 && on.vehicles[point.index - 1].position_m < point.front_m) --point.index;
        return point;
    }

    double front_m(const Lane& on, int number) const {
        const Trip& trip = trip_of(number);
        double highest_m = on.stop_line_m;
        const int route = routes_.option(on.number, w_.model.demand.turn_of_trip(number, 0)).route;
        if (route >= 0 && w_.route_of(route).size() > 1) {
            const double margin_m = w_.kind(policy_of(number)).settings().give_way.margin_m;
            const double before_area_m = on.length_m + w_.lane(w_.route_of(route)[1]).first_conflict_m - margin_m;
            highest_m = std::max(std::min(highest_m, before_area_m), 0.0);
        }
        const double base_m = std::min(static_cast<double>(trip.length_m), highest_m);
        const double lowest_m = w_.connections_to(on.number).empty() ? 0.0 : base_m;
        using enum Trip::DepartPosition;
        switch (trip.depart_position) {
            case given:
                return std::clamp(static_cast<double>(trip.front_m), lowest_m, highest_m);
            case last: {
                const int policy = policy_of(number);
                const double front_m = on.vehicles.empty() ? highest_m - w_.kind(policy).settings().stop.margin_m
                                                           : on.vehicles.back().rear_m() -
                                                                 w_.desired_gap_m(policy, on.vehicles.back().speed_mps);
                return std::clamp(front_m, lowest_m, highest_m);
            }
            case random:
                return std::lerp(base_m, highest_m, drawn(number, 2));
            case free:
                return std::lerp(base_m, highest_m, drawn(number, 3 + static_cast<std::uint64_t>(w_.tick)));
            case base:
                break;
        }
        return base_m;
    }

    // The leader of a new vehicle.
    struct EntryLeader {
        bool exists = false;
        double gap_m = 0.0;
        double speed_mps = 0.0;
    };

    EntryLeader leader_at(const Point& point, const RoutePlace& place) const {
        const Lane& on = w_.lane(point.lane);
        if (point.index > 0) {
            const Vehicle& ahead = on.vehicles[point.index - 1];
            return {true, ahead.rear_m() - point.front_m, ahead.speed_mps};
        }
        const Ahead ahead = perception_.beyond(point.lane, point.front_m, place, w_.common_driver().cacc.radar_range_m);
        if (ahead.vehicle == nullptr) return {};
        return {true, ahead.rear_m() - point.front_m, ahead.vehicle->speed_mps};
    }

    // Returns true if the follower keeps its desired gap and the distance to brake comfortably. At the end of a lane,
    // the approaching vehicles must be able to stop behind the new vehicle.
    bool follower_has_room(const Point& point, double rear_m, double speed_mps) const {
        const Lane& on = w_.lane(point.lane);
        if (point.index == on.vehicles.size()) return !approaching_vehicle_cannot_stop(on, rear_m);
        const Vehicle& follower = on.vehicles[point.index];
        const double b = w_.driver(follower).cacc.deceleration_comfort_mps2;
        return rear_m - follower.position_m + kRounding_m >=
               w_.desired_gap_m(follower.policy, follower.speed_mps) + braking_m(follower.speed_mps, speed_mps, b);
    }

    bool approaching_vehicle_cannot_stop(const Lane& on, double rear_m) const {
        constexpr double kReaction_s = 1.0;
        constexpr double kApproach_m = 60.0;
        const auto is_too_near = [&](const Vehicle& v, double distance_m) {
            const double b = w_.driver(v).cacc.deceleration_comfort_mps2;
            return v.speed_mps * kReaction_s + braking_m(v.speed_mps, 0.0, b) + w_.kind(v).standstill_gap_m >
                   distance_m;
        };
        for (const int number : w_.connections_to(on.number)) {
            const Lane& connection = w_.lane(number);
            for (const Vehicle& v : connection.vehicles) {
                if (is_too_near(v, rear_m + connection.length_m - v.position_m)) return true;
            }
            const Lane& origin = w_.lane(connection.origin);
            for (const Vehicle& v : origin.vehicles) {
                const double distance_m = origin.length_m + connection.length_m - v.position_m;
                if (distance_m > connection.length_m + kApproach_m) break;
                if (v.next_lane == number && is_too_near(v, rear_m + distance_m)) return true;
            }
        }
        return false;
    }

    double wanted_speed_mps(int number, const Lane& on, double limit_mps, const EntryLeader& leader) const {
        const Trip& trip = trip_of(number);
        using enum Trip::DepartSpeed;
        switch (trip.depart_speed) {
            case limit:
                return limit_mps;
            case given:
                return std::min(limit_mps, static_cast<double>(trip.speed_mps));
            case last:
                return leader.exists ? std::min(limit_mps, leader.speed_mps) : limit_mps;
            case mean: {
                if (on.vehicles.empty()) return limit_mps;
                double sum_mps = 0.0;
                for (const Vehicle& v : on.vehicles) sum_mps += v.speed_mps;
                return std::min(limit_mps, sum_mps / static_cast<double>(on.vehicles.size()));
            }
            case random:
                break;
        }
        return limit_mps * drawn(number, 1);
    }

    // Returns the highest safe speed behind the leader, at least that of the leader; below 0: the gap is too short.
    double safe_speed_mps(int number, double wanted_mps, const EntryLeader& leader) const {
        constexpr int kHalvings = 12;
        const int policy = policy_of(number);
        const double b = w_.kind(policy).settings().stop.deceleration_mps2;
        const auto is_safe = [&](double speed_mps) {
            return leader.gap_m + kRounding_m >=
                   w_.desired_gap_m(policy, speed_mps) + braking_m(speed_mps, leader.speed_mps, b);
        };
        if (!leader.exists || is_safe(wanted_mps)) return wanted_mps;
        double safe_mps = std::min(wanted_mps, leader.speed_mps);
        if (trip_of(number).depart_speed == Trip::DepartSpeed::given || !is_safe(safe_mps)) return -1.0;
        double unsafe_mps = wanted_mps;
        for (int k = 0; k < kHalvings; ++k) {
            const double middle_mps = 0.5 * (safe_mps + unsafe_mps);
            (is_safe(middle_mps) ? safe_mps : unsafe_mps) = middle_mps;
        }
        return safe_mps;
    }

    // Returns true if a vehicle without priority crosses the route of the new vehicle, or has accepted a gap to do so.
    bool is_crossed(int route) const {
        const std::vector<int>& lanes = w_.route_of(route);
        if (lanes.size() < 2) return false;
        for (const Conflict& conflict : w_.lane(lanes[1]).conflicts) {
            if (!conflict.other_yields) continue;
            for (const Occupant& other : w_.occupants[static_cast<std::size_t>(conflict.other)]) {
                if (other.rear_m < conflict.other_to_m) return true;
            }
            for (const Vehicle& v : w_.lane(w_.lane(conflict.other).origin).vehicles) {
                if (v.accepted_gap_on == conflict.other) return true;
            }
        }
        return false;
    }

    // Returns false if there is no room.
    bool insert(int number, const Point& point) {
        constexpr double kNearLine_m = 40.0;
        const Trip& trip = trip_of(number);
        Lane& on = w_.lane(point.lane);
        const int policy = policy_of(number);
        const Turn turn = w_.model.demand.turn_of_trip(number, 0);
        const int route = routes_.route_on_approach(trip.approach, turn);
        const int lane_route = routes_.option(on.number, turn).route;
        const EntryLeader leader = leader_at(point, {lane_route, 0, number, 0});
        const double to_line_m = on.stop_line_m - point.front_m;
        double limit_mps = w_.free_speed_mps(on, policy);
        if (lane_route < 0) limit_mps = std::min(limit_mps, 0.5 * on.stop_line_m);
        if (on.signal_group >= 0) {
            const double b = w_.kind(policy).settings().stop.deceleration_mps2;
            limit_mps = std::min(limit_mps, std::sqrt(2.0 * b * to_line_m));
        }
        const double speed_mps = safe_speed_mps(number, wanted_speed_mps(number, on, limit_mps, leader), leader);
        const double rear_m = point.front_m - static_cast<double>(trip.length_m);
        if (speed_mps < 0.0 || !follower_has_room(point, rear_m, speed_mps)) return false;
        if (lane_route >= 0 && to_line_m < kNearLine_m && is_crossed(lane_route)) return false;
        Vehicle v = entrance_.create(policy, static_cast<double>(trip.length_m), point.front_m, speed_mps);
        v.route = route;
        v.trip = number;
        v.entry_tick = w_.tick;
        routes_.enter_trip_edge(on.number, v, 0);
        entrance_.insert(on, point.index, std::move(v));
        if (point.index + 1 == on.vehicles.size()) return true;
        for (Vehicle& behind : on.vehicles) behind.is_in_queue = false;
        Vehicle& follower = on.vehicles[point.index + 1];
        const Vehicle& own = on.vehicles[point.index];
        follower.leader_id = own.id;
        follower.is_platoon_leader = false;
        follower.radar.assign(follower.radar.size(), {own.rear_m() - follower.position_m,
                                                      follower.speed_mps - own.speed_mps, follower.speed_mps});
        on.stopping_id = -1;
        return true;
    }

    World& w_;
    Routes& routes_;
    Entrance& entrance_;
    Perception perception_;
    std::vector<std::vector<int>> waiting_;  // [approach] trips that are due, the oldest first
    std::size_t next_ = 0;
    int last_late_ = -1;
};

}  // namespace stopline::reference_engine
