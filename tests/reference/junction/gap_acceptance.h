// Gap acceptance of the reference engine: the next vehicle with priority, and the gap that a yielding vehicle needs.
// The rules are those of the comments in core/sim/junction/arrivals.h and gap_acceptance.h.
#pragma once

#include "reference/junction/merging.h"

namespace stopline::reference_engine {

// The next vehicle that reaches a conflict area.
struct Arrival {
    double time_s = 1e9;  // from the start of the step; 1e9: nobody comes
    Vehicle* vehicle = nullptr;

    void keep_earlier(double other_time_s, Vehicle& other) {
        if (other_time_s < time_s) *this = {other_time_s, &other};
    }
};

// The vehicle to which a candidate must yield.
struct GapBlocker {
    Vehicle* vehicle = nullptr;  // null: none
    WaitReason reason = WaitReason::priority;
};

class GapAcceptance {
public:
    GapAcceptance(World& world, Resolutions& resolutions) : w_(world), merging_(world), resolutions_(resolutions) {}

    // Returns the vehicle to which a candidate must yield, if it waits at `wait_m` and can start after `delay_s`. Sets
    // Vehicle::accepted_gap_on.
    GapBlocker blocker(const Candidate& c, double wait_m, double delay_s) {
        Vehicle& v = *c.vehicle;
        const bool had_gap = v.accepted_gap_on == c.connection;
        v.accepted_gap_on = -1;
        Resolution* const resolution = c.is_stopped() ? resolutions_.find(v) : nullptr;
        if (resolution != nullptr) {
            resolution->last_tick = w_.tick;
        } else if (Vehicle* const winner = yield_cycle_winner(c); winner != nullptr) {
            return {winner, WaitReason::intruder};
        }
        for (const Conflict& conflict : w_.lane(c.connection).conflicts) {
            if (!conflict.yields || c.front_m > conflict.from_m) continue;
            const double until_s = needed_s(c, conflict, wait_m, delay_s, had_gap && !c.is_stopped());
            const Arrival arrival = next_arrival(v, conflict, until_s, resolution != nullptr);
            if (arrival.time_s >= until_s) continue;
            ++w_.situations.gaps_refused;
            return {arrival.vehicle, WaitReason::priority};
        }
        v.accepted_gap_on = c.connection;
        if (w_.is_imported) v.yield_tick = -2;
        w_.situations.gaps_accepted += had_gap ? 0 : 1;
        return {};
    }

    // Returns a vehicle of the other connection that has accepted a gap and can no longer stop comfortably before its
    // first conflict area; null if there is none.
    Vehicle* committed_vehicle(const Conflict& conflict) const {
        const Lane& other = w_.lane(conflict.other);
        Lane& approach = w_.lane(other.origin);
        for (Vehicle& v : approach.vehicles) {
            if (v.next_lane != conflict.other) continue;
            const DriverSettings& driver = w_.driver(v);
            const double to_area_m =
                approach.length_m + other.first_conflict_m - driver.give_way.margin_m - v.position_m;
            const bool drives_through = v.accepted_gap_on == conflict.other && !v.is_slow();
            return drives_through && to_area_m < comfortable_braking_m(driver, v.speed_mps) ? &v : nullptr;
        }
        return nullptr;
    }

    // Returns true if the committed vehicle is still in the conflict area when the candidate can arrive.
    bool occupies_area_on_arrival(const Candidate& c, const Conflict& conflict, const Vehicle& other) const {
        const double in_s = earliest_arrival_s(std::max(conflict.from_m - c.front_m, 0.0), c.vehicle->speed_mps,
                                               w_.driver(*c.vehicle).give_way.approach_acceleration_mps2,
                                               w_.lane(c.connection).limit_mps);
        const Lane& lane = w_.lane(conflict.other);
        const double to_connection_s = travel_s(w_.driver(other), w_.lane(lane.origin).length_m - other.position_m,
                                                other.speed_mps, lane.limit_mps);
        const double through_m = conflict.other_to_m + other.length_m;
        return to_connection_s + through_m / std::min(other.speed_mps, lane.limit_mps) > in_s;
    }

private:
    // Returns the travel time over a distance. A vehicle above the limit of its connection brakes towards it.
    static double travel_s(const DriverSettings& driver, double distance_m, double speed_mps, double limit_mps) {
        constexpr double kMinSpeed_mps = 2.0;
        const double b = driver.free_drive.deceleration_mps2;
        const double slowing_m = 0.5 * (speed_mps * speed_mps - limit_mps * limit_mps) / b;
        if (slowing_m <= 0.0) return std::max(distance_m, 0.0) / std::max(speed_mps, kMinSpeed_mps);
        if (distance_m >= slowing_m) return (distance_m - slowing_m) / speed_mps + (speed_mps - limit_mps) / b;
        return (speed_mps - std::sqrt(speed_mps * speed_mps - 2.0 * b * std::max(distance_m, 0.0))) / b;
    }

    // Returns the time until a vehicle at `front_m` no longer hinders the next vehicle with priority: a crossing
    // vehicle has left the area, a merging vehicle has reached it and has had a second to speed up.
    double passing_s(const Candidate& c, const Conflict& conflict, double front_m, double speed_mps) const {
        constexpr double kMergingReserve_s = 1.0;
        const bool merges = merging_.is_merge(c.connection, conflict);
        const double to_m = merges ? conflict.from_m : conflict.to_m + c.vehicle->length_m;
        const double time_s = earliest_arrival_s(std::max(to_m - front_m, 0.0), speed_mps,
                                                 w_.driver(*c.vehicle).give_way.approach_acceleration_mps2,
                                                 w_.lane(c.connection).limit_mps);
        return merges ? time_s + kMergingReserve_s : time_s;
    }

    // Returns the time since the latest vehicle in the area reached it, at the speed limit; 0 if the area is free.
    double since_last_arrival_s(const Conflict& conflict) const {
        double since_s = 0.0;
        for (const Occupant& other : w_.occupants[static_cast<std::size_t>(conflict.other)]) {
            if (other.front_m > conflict.other_from_m && other.rear_m < conflict.other_to_m)
                since_s = (other.front_m - conflict.other_from_m) / w_.lane(conflict.other).limit_mps;
        }
        return since_s;
    }

    // Returns the time in which a vehicle with priority comes within the distance of an emergency stop, if it drives at
    // the speed limit and responds a step later.
    double emergency_stop_s(const Conflict& conflict) const {
        constexpr double kResponse_s = 0.3;
        const Lane& approach = w_.lane(w_.lane(conflict.other).origin);
        const double speed_mps = (w_.is_meso ? w_.scenario.meso.speed_factor : 1.0) * approach.limit_mps;
        return w_.step_s + emergency_braking_m(w_, speed_mps) / speed_mps + (w_.is_meso ? 0.0 : kResponse_s);
    }

    // Returns the earliest arrival of the next vehicle with priority at which the candidate accepts the gap. The
    // critical gap begins when a vehicle with priority reaches the area, or now if the area is free. It holds for a
    // start from rest. While the candidate moves, a critical lag above 0 replaces the critical gap. The candidate does
    // not hinder the next vehicle. Exception: at its waiting position in a generated network it only leaves that
    // vehicle the time for an emergency stop. `has_begun`: the candidate moves and has accepted the gap before.
    double needed_s(const Candidate& c, const Conflict& conflict, double wait_m, double delay_s, bool has_begun) const {
        constexpr double kWaitingPlace_m = 1.0;
        const DriverSettings& driver = w_.driver(*c.vehicle);
        const double speed_mps = c.vehicle->speed_mps;
        const double now_s = passing_s(c, conflict, c.front_m, speed_mps);
        const double to_wait_s = travel_s(driver, wait_m - c.front_m, speed_mps, w_.lane(c.connection).limit_mps);
        const double later_s = now_s - passing_s(c, conflict, wait_m, 0.0);
        double gap_s = driver.give_way.critical_gap_s - since_last_arrival_s(conflict) + later_s;
        if (driver.give_way.critical_lag_s > 0.0 && !c.is_stopped()) gap_s = driver.give_way.critical_lag_s + to_wait_s;
        const double free_s = has_begun ? now_s : std::max(gap_s, now_s);
        if (w_.is_imported) return free_s;
        const double stop_s = emergency_stop_s(conflict) + to_wait_s + delay_s;
        return std::max(c.front_m >= wait_m - kWaitingPlace_m ? std::min(gap_s, free_s) : free_s, stop_s);
    }

    // Imported networks: returns a vehicle that must yield to the stopped candidate but has accepted a gap; null if
    // there is none.
    Vehicle* yield_cycle_winner(const Candidate& c) const {
        if (!w_.is_imported || !c.is_stopped()) return nullptr;
        for (const Conflict& conflict : w_.lane(c.connection).conflicts) {
            Lane& approach = w_.lane(w_.lane(conflict.other).origin);
            if (!conflict.other_yields || approach.vehicles.empty() || approach.stop_index == 0) continue;
            Vehicle& first = approach.vehicles.front();
            const bool has_gap = first.next_lane == conflict.other && first.accepted_gap_on == conflict.other;
            if (has_gap && !is_yielding(w_, first)) return &first;
        }
        return nullptr;
    }

    double approach_mps2(const Vehicle& yielding) const {
        return w_.driver(yielding).give_way.approach_acceleration_mps2;
    }

    // Returns the vehicle that stops at a line, so that nobody behind it reaches the connection; null if there is none.
    // At a green signal, only a vehicle with another signal counts.
    const Vehicle* stopping_at_signal(const Lane& approach, int connection) const {
        if (approach.stop_index < 0) return nullptr;
        const Vehicle& stopping = approach.vehicles[static_cast<std::size_t>(approach.stop_index)];
        if (w_.light(w_.group_of(approach, connection)) != Light::green) return &stopping;
        if (!approach.has_movement_signals) return nullptr;
        return w_.light(w_.group_of(approach, stopping.next_lane)) == Light::green ? nullptr : &stopping;
    }

    // Returns the next arrival at a conflict area on the other connection, as the vehicle `yielding` expects it: on the
    // connection, on its approach lane, or from upstream within `horizon_s`. Vehicles that let others go or are in a
    // queue do not arrive soon, nor do vehicles behind them. `ignores_crawling`: nor do slow vehicles.
    Arrival next_arrival(const Vehicle& yielding, const Conflict& conflict, double horizon_s,
                         bool ignores_crawling) const {
        const Lane& other = w_.lane(conflict.other);
        Lane& approach = w_.lane(other.origin);
        const Vehicle* const stopping = stopping_at_signal(approach, conflict.other);
        const auto is_ignored = [&](const Vehicle& v) { return ignores_crawling && v.is_slow(); };
        Arrival soonest;
        for (const Occupant& occupant : w_.occupants[static_cast<std::size_t>(conflict.other)]) {
            Vehicle& v = *occupant.vehicle;
            if (occupant.front_m > conflict.other_from_m) continue;
            const bool waits = is_yielding_before(w_, v, conflict.other_from_m) && lets_others_go(w_, v);
            if (waits || &v == stopping || is_ignored(v) || is_behind_yielding_vehicle(w_, conflict.other, occupant))
                return soonest;
            const double distance_m = conflict.other_from_m - occupant.front_m;
            soonest.keep_earlier(earliest_arrival_s(distance_m, v.speed_mps, approach_mps2(yielding), other.limit_mps),
                                 v);
        }
        if (!approach.vehicles.empty() &&
            (is_blocked_by_leader(w_, approach.vehicles.front()) || lets_others_go(w_, approach.vehicles.front())))
            return soonest;
        const double to_area_m = approach.length_m + conflict.other_from_m;
        for (Vehicle& v : approach.vehicles) {
            const double distance_m = to_area_m - v.position_m;
            if (distance_m > horizon_s * approach.limit_mps || &v == stopping) break;
            // Imported networks: vehicles may go before one that the keep-clear rule holds at rest.
            const bool is_held = approach.is_held && static_cast<std::ptrdiff_t>(v.index) == approach.stop_index;
            if (w_.is_imported && is_held && v.is_slow()) return soonest;
            if (v.position_m > approach.stop_line_m || v.next_lane != conflict.other) continue;
            if (is_ignored(v)) break;
            soonest.keep_earlier(earliest_arrival_s(distance_m, v.speed_mps, approach_mps2(yielding), other.limit_mps),
                                 v);
            return soonest;
        }
        look_upstream(yielding, {approach.number, conflict.other, to_area_m, 0}, horizon_s, soonest);
        return soonest;
    }

    struct Upstream {
        int lane = -1;
        int connection = -1;     // the connection that follows `lane`
        double to_area_m = 0.0;  // from the start of `lane`
        int depth = 0;
    };

    // Searches the lanes upstream of a lane for moving vehicles that will take the connection.
    void look_upstream(const Vehicle& yielding, const Upstream& here, double horizon_s, Arrival& soonest) const {
        constexpr int kMaxDepth = 3;
        if (here.depth == kMaxDepth) return;
        const double limit_mps = w_.lane(here.lane).limit_mps;
        const Turn turn = w_.lane(here.connection).turn;
        const auto consider = [&](Vehicle& v, double distance_m) {
            if (v.is_slow() || distance_m > horizon_s * limit_mps) return;
            const bool is_unknown = v.trip < 0 && v.following_turn == Turn::none;
            if (here.depth == 0 && !is_unknown && v.following_turn != turn) return;
            soonest.keep_earlier(earliest_arrival_s(distance_m, v.speed_mps, approach_mps2(yielding), limit_mps), v);
        };
        for (const int number : w_.connections_to(here.lane)) {
            Lane& connection = w_.lane(number);
            if (here.to_area_m > horizon_s * connection.limit_mps) continue;
            if (!connection.vehicles.empty()) {
                Vehicle& first = connection.vehicles.front();
                consider(first, here.to_area_m + connection.length_m - first.position_m);
                continue;
            }
            Lane& origin = w_.lane(connection.origin);
            const double from_m = here.to_area_m + connection.length_m + origin.length_m;
            const auto takes_it = [&](const Vehicle& v) { return v.next_lane == number; };
            const auto first = std::find_if(origin.vehicles.begin(), origin.vehicles.end(), takes_it);
            if (first != origin.vehicles.end()) consider(*first, from_m - first->position_m);
            look_upstream(yielding, {connection.origin, number, from_m, here.depth + 1}, horizon_s, soonest);
        }
    }

    World& w_;
    Merging merging_;
    Resolutions& resolutions_;
};

}  // namespace stopline::reference_engine
