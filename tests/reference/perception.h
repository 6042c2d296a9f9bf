// Leaders of the reference engine: the nearest vehicle ahead of each vehicle, and vehicles that it hides. The rules are
// those of the comments in core/sim/perception.
#pragma once

#include "reference/network.h"

namespace stopline::reference_engine {

// A vehicle ahead of an observer. Positions are measured from the start of the observer's lane.
struct Ahead {
    const Vehicle* vehicle = nullptr;
    double start_m = 0.0;  // start of the vehicle's lane

    double rear_m() const { return start_m + vehicle->rear_m(); }
};

// The place of an observer on its route and its trip.
struct RoutePlace {
    int route = -1;  // -1: no route from the lane, so the observer must change lanes
    int route_index = 0;
    int trip = -1;
    int trip_edge = 0;
};

class Perception {
public:
    explicit Perception(const World& world) : w_(world) {}

    // Returns the leader of a vehicle beyond the end of its lane. `hidden`: receives a vehicle on the route that the
    // leader hides.
    Ahead beyond_lane(const Vehicle& v, double range_m, Ahead* hidden = nullptr) const {
        // A vehicle without a next lane leaves the network here, or must change lanes before.
        if (v.next_lane < 0) return diverging(v.lane, -1, -kNoLimit);
        return beyond(v.lane, v.position_m, {v.route, v.route_index, v.trip, v.trip_edge}, range_m, hidden);
    }

    // Does the same for an observer at a position of a lane.
    Ahead beyond(int lane, double position_m, const RoutePlace& place, double range_m, Ahead* hidden = nullptr) const {
        if (place.route < 0) return diverging(lane, -1, -kNoLimit);
        const Ahead leader = on_route(lane, position_m, place, range_m, hidden);
        if (leader.vehicle != nullptr || place.trip < 0) return leader;
        return on_trip(lane, position_m, place, range_m);
    }

    // Returns the last vehicle of the first occupied lane of a route from route[index] on, which begins at `start_m`.
    Ahead last_on_route(const std::vector<int>& route, std::size_t index, double start_m, double position_m,
                        double range_m) const {
        for (std::size_t k = index; k < route.size() && start_m - position_m <= range_m; ++k) {
            const Lane& on = w_.lane(route[k]);
            if (!on.vehicles.empty()) return {&on.vehicles.back(), start_m};
            start_m += on.length_m;
        }
        return {};
    }

    // Returns true if the rear of `ahead` is still on a lane that merges into the route of `v`.
    bool has_rear_on_merging_path(const Vehicle& v, const Vehicle& ahead) const {
        const std::vector<int>& route = w_.route_of(v.route);
        const auto is_on_route = [&](int lane) { return std::find(route.begin(), route.end(), lane) != route.end(); };
        const int previous = ahead.previous_lane;
        if (ahead.rear_m() >= 0.0) return false;
        if (previous < 0) return ahead.second_previous_lane >= 0 && !is_on_route(ahead.second_previous_lane);
        if (w_.lane(previous).origin == v.lane) return false;
        if (!is_on_route(previous)) return true;
        const double rear_on_previous_m = ahead.rear_m() + w_.lane(previous).length_m;
        return rear_on_previous_m < 0.0 && ahead.second_previous_lane >= 0 && !is_on_route(ahead.second_previous_lane);
    }

    // Returns the leader of each vehicle of a lane.
    std::vector<Leader> leaders_on(const Lane& on) const {
        constexpr double kTouch_m = 1e-4;
        std::vector<Leader> leaders;
        for (std::size_t k = 0; k < on.vehicles.size(); ++k) {
            const Vehicle& v = on.vehicles[k];
            const Ahead ahead =
                k > 0 ? Ahead{&on.vehicles[k - 1], 0.0} : beyond_lane(v, w_.common_driver().cacc.radar_range_m);
            Leader leader;
            leader.speed_mps = v.speed_mps;
            leader.gap_m = kNoLeaderGap_m - v.length_m - v.position_m;
            if (ahead.vehicle != nullptr) {
                const Vehicle& other = *ahead.vehicle;
                const double reach_m = ahead.start_m + other.position_m - v.position_m;
                double length_m = other.length_m;
                // Right of way prevents contact with the rear of a vehicle that still merges.
                if (k == 0 && reach_m < length_m && has_rear_on_merging_path(v, other))
                    length_m = stored(std::max(reach_m - kTouch_m, 0.0));
                leader = {other.id, ahead.start_m + other.position_m - length_m - v.position_m, other.speed_mps,
                          other.acceleration_mps2, &other};
            }
            leaders.push_back(leader);
        }
        return leaders;
    }

    // Full dynamics: returns the highest acceleration that the vehicles beyond the leader allow; infinity if none
    // matters. `hidden`: the nearest vehicle on the route of `v` that its leader hides.
    double hidden_leader_demand_mps2(const Vehicle& v, const Ahead& hidden) const {
        const VehicleKind& kind = w_.kind(v);
        const double rear_m = has_rear_on_merging_path(v, *hidden.vehicle) ? hidden.start_m : hidden.rear_m();
        View p;
        p.gap_m = rear_m - v.position_m;
        if (p.gap_m > stopping_m(v) + kind.standstill_gap_m) return kNoLimit;
        p.closing_mps = v.speed_mps - hidden.vehicle->speed_mps;
        p.acceleration_mps2 = hidden.vehicle->acceleration_mps2;
        p.request_mps2 = hidden.vehicle->request_mps2;
        const double growth_m = std::max(w_.desired_gap_m(v.policy, v.speed_mps) - kind.standstill_gap_m, 0.0);
        return hidden_leader_mps2(kind.driver, v.speed_mps, kind.standstill_gap_m, growth_m, p);
    }

    // Full dynamics: returns the demands of hidden leaders on the vehicles of a lane. A vehicle behind the first one
    // can have a hidden leader if no vehicle ahead of it on the lane takes the same connection.
    std::vector<double> hidden_leader_demands(const Lane& on) const {
        constexpr double kMinLookBack_m = 60.0;
        std::vector<double> demands(on.vehicles.size(), kNoLimit);
        if (on.vehicles.empty()) return demands;
        const Vehicle& first = on.vehicles.front();
        Ahead hidden;
        beyond_lane(first, w_.common_driver().cacc.radar_range_m, &hidden);
        if (hidden.vehicle != nullptr) demands[0] = hidden_leader_demand_mps2(first, hidden);
        if ((on.next.size() <= 1 && !w_.is_imported) || first.speed_mps <= 0.0) return demands;
        double look_back_m = kMinLookBack_m;
        for (const VehicleKind& kind : w_.kinds)
            look_back_m = std::max(look_back_m, stopping_m(kind.settings(), on.limit_mps));
        for (std::size_t k = 1; k < on.vehicles.size(); ++k) {
            const Vehicle& v = on.vehicles[k];
            if (v.position_m <= on.length_m - look_back_m) break;
            const auto takes_same = [&](const Vehicle& ahead) { return ahead.next_lane == v.next_lane; };
            const auto end = on.vehicles.begin() + static_cast<std::ptrdiff_t>(k);
            if (v.next_lane < 0 || std::any_of(on.vehicles.begin(), end, takes_same)) continue;
            const Ahead beyond = last_on_route(w_.route_of(v.route), static_cast<std::size_t>(v.route_index) + 1,
                                               on.length_m, v.position_m, stopping_m(v) + w_.kind(v).standstill_gap_m);
            if (beyond.vehicle != nullptr) demands[k] = hidden_leader_demand_mps2(v, beyond);
            // The first vehicle of the lane may be clear of a vehicle that is in the way of this one.
            const Ahead beside = diverging(on.number, v.next_lane, -kNoLimit);
            const bool differs = !w_.lane(v.next_lane).diverge_ends_m.empty();
            if (differs && beside.vehicle != nullptr)
                demands[k] = std::min(demands[k], hidden_leader_demand_mps2(v, beside));
        }
        return demands;
    }

private:
    static double stopping_m(const DriverSettings& driver, double speed_mps) {
        return comfortable_braking_m(driver, speed_mps) + kLanding_s * speed_mps;
    }
    double stopping_m(const Vehicle& v) const { return stopping_m(w_.driver(v), v.speed_mps); }

    // The connections of a lane overlap just beyond its end. Returns the vehicle there with the rear furthest upstream,
    // among those whose front is more than `front_m` beyond the end of the lane.
    // `own`: connection of the observer, which ignores vehicles that are clear of this connection. -1: unknown, so only
    // vehicles that are clear of all connections are ignored.
    Ahead diverging(int lane, int own, double front_m) const {
        const Lane& from = w_.lane(lane);
        Ahead nearest;
        for (const int next : from.next) {
            const Lane& connection = w_.lane(next);
            if (!connection.is_connection()) continue;
            double clear_m = connection.diverge_end_m;
            for (std::size_t k = 0; k < connection.diverge_ends_m.size(); ++k)
                if (from.next[k] == own) clear_m = connection.diverge_ends_m[k];
            if (front_m >= clear_m) continue;  // the observer itself is past this position
            const auto consider = [&](const Vehicle& v, double start_m) {
                const double rear_m = start_m + v.rear_m();
                if (rear_m >= clear_m || start_m + v.position_m <= front_m) return;
                if (nearest.vehicle == nullptr || from.length_m + rear_m < nearest.rear_m())
                    nearest = {&v, from.length_m + start_m};
            };
            for (const Vehicle& v : connection.vehicles) consider(v, 0.0);
            for (const Vehicle& v : w_.lane(connection.exit).vehicles) {
                if (v.previous_lane == next) consider(v, connection.length_m);
            }
        }
        return nearest;
    }

    Ahead on_route(int lane, double position_m, const RoutePlace& place, double range_m, Ahead* hidden) const {
        const Lane& here = w_.lane(lane);
        const std::vector<int>& route = w_.route_of(place.route);
        const auto next_index = static_cast<std::size_t>(place.route_index) + 1;
        if (here.next.size() <= 1 && here.length_m - position_m > range_m) return {};
        Ahead beside;
        if (here.next.size() > 1 || next_index == route.size()) {
            beside = diverging(lane, next_index == route.size() ? -1 : route[next_index], -kNoLimit);
        } else if (here.is_connection() && position_m < here.diverge_end_m) {
            beside = diverging(here.origin, lane, position_m);
            beside.start_m -= w_.lane(here.origin).length_m;
        }
        const Ahead own = last_on_route(route, next_index, here.length_m, position_m, range_m);
        if (own.vehicle == nullptr) return beside;
        if (beside.vehicle == nullptr) return own;
        // If the leader on the route came from another lane, its rear may not be on the route.
        const int previous = own.vehicle->previous_lane;
        const bool is_off_route = previous >= 0 && std::find(route.begin(), route.end(), previous) == route.end();
        const double rear_m = is_off_route ? std::max(own.rear_m(), own.start_m) : own.rear_m();
        if (rear_m <= beside.rear_m()) return own;
        if (hidden != nullptr && own.vehicle != beside.vehicle) *hidden = own;
        return beside;
    }

    // Continues the search on the later edges of the trip.
    Ahead on_trip(int lane, double position_m, const RoutePlace& place, double range_m) const {
        const std::vector<int>& route = w_.route_of(place.route);
        double start_m = 0.0;
        int current = lane;
        const auto advance = [&](int next) {
            start_m += w_.lane(current).length_m;
            current = next;
        };
        for (std::size_t k = static_cast<std::size_t>(place.route_index) + 1; k < route.size(); ++k) advance(route[k]);
        for (int edge = place.trip_edge + 1;; ++edge) {
            const Turn turn = w_.model.demand.turn_of_trip(place.trip, edge);
            const int next_route = turn == Turn::none ? -1 : first_route(current, turn);
            const bool is_known = next_route >= 0 && connections_with(current, turn) == 1;
            const Ahead beside = diverging(current, is_known ? w_.route_of(next_route)[1] : -1, -kNoLimit);
            if (beside.vehicle != nullptr) return {beside.vehicle, start_m + beside.start_m};
            if (next_route < 0) return {};
            const std::vector<int>& lanes = w_.route_of(next_route);
            for (std::size_t k = 1; k < lanes.size(); ++k) {
                advance(lanes[k]);
                if (start_m - position_m > range_m) return {};
                if (!w_.lane(current).vehicles.empty()) return {&w_.lane(current).vehicles.back(), start_m};
            }
        }
    }

    // Returns the route with a turn that begins on a lane; of several, the last one of the list. -1: none.
    int first_route(int lane, Turn turn) const {
        for (std::size_t route = w_.model.graph.routes.size(); route-- > 0;) {
            const std::vector<int>& lanes = w_.route_of(static_cast<int>(route));
            if (lanes.front() == lane && lanes.size() > 1 && w_.lane(lanes[1]).turn == turn)
                return static_cast<int>(route);
        }
        return -1;
    }

    // Returns the number of connections of a lane with this turn.
    int connections_with(int lane, Turn turn) const {
        const std::vector<int>& next = w_.lane(lane).next;
        const auto has_turn = [&](int k) { return w_.lane(k).turn == turn; };
        return static_cast<int>(std::count_if(next.begin(), next.end(), has_turn));
    }

    const World& w_;
};

}  // namespace stopline::reference_engine
