// Deadlock avoidance of the reference engine: a vehicle does not enter a conflict area if its body would complete a
// cycle of slow vehicles that block each other.
#pragma once

#include <algorithm>
#include <vector>

#include "reference/junction/candidate.h"

namespace stopline::reference_engine {

// A conflict area that a candidate must not enter yet.
struct KeptOutArea {
    double from_m = kNoLimit;     // start of the area on the candidate's connection; infinity: no such area
    Vehicle* crossing = nullptr;  // the vehicle that must cross the area first
};

class DeadlockAvoidance {
public:
    DeadlockAvoidance(World& world, const Candidate& c)
        : w_(world), c_(c), margin_m_(world.driver(*c.vehicle).give_way.margin_m) {}

    // Returns the nearest area that the candidate must keep clear.
    KeptOutArea area() {
        for (const Conflict& conflict : conflicts(c_.connection)) {
            if (conflict.from_m < c_.front_m) continue;
            for (Vehicle* const v : slow_in_area(conflict)) check_stop(conflict.from_m - margin_m_, v);
        }
        for (const Occupant& leader : w_.occupants[static_cast<std::size_t>(c_.connection)]) {
            if (leader.rear_m >= c_.front_m && leader.vehicle->is_slow())
                check_stop(leader.rear_m - w_.kind(*c_.vehicle).standstill_gap_m, leader.vehicle);
        }
        return area_;
    }

private:
    const std::vector<Conflict>& conflicts(int connection) const { return w_.lane(connection).conflicts; }

    // Returns the slow vehicles of connection `conflict.other` that are in the area.
    std::vector<Vehicle*> slow_in_area(const Conflict& conflict) const {
        std::vector<Vehicle*> found;
        for (const Occupant& other : w_.occupants[static_cast<std::size_t>(conflict.other)]) {
            if (other.front_m > conflict.other_from_m && other.rear_m < conflict.other_to_m && other.vehicle->is_slow())
                found.push_back(other.vehicle);
        }
        return found;
    }

    // Checks the areas that the candidate would block if it stopped at `place_m` behind `blocker`. Before the first
    // area that closes a cycle the candidate would stop, too.
    void check_stop(double place_m, Vehicle* blocker) {
        for (const Conflict& area : conflicts(c_.connection)) {
            const double stop_m = area.from_m - margin_m_;
            if (area.from_m < c_.front_m || area.from_m >= std::min(place_m, area_.from_m)) continue;
            if (area.to_m <= place_m - c_.vehicle->length_m) continue;
            if (!c_.is_stopped() && !can_stop_within(stop_m - c_.front_m)) continue;
            if (Vehicle* const crossing = find_crossing(area, blocker); crossing != nullptr) {
                area_ = {area.from_m, crossing};
                return check_stop(stop_m, crossing);
            }
        }
    }

    bool can_stop_within(double distance_m) const {
        constexpr double kResponse_s = 0.3;
        const double speed_mps = c_.vehicle->speed_mps;
        return emergency_braking_m(w_, speed_mps) + (w_.is_meso ? 0.0 : kResponse_s * speed_mps) <= distance_m;
    }

    // Returns a vehicle that must still cross the area and that is in the path of `start`, directly or through further
    // slow vehicles; null: none.
    Vehicle* find_crossing(const Conflict& area, Vehicle* start) const {
        constexpr std::size_t kMaxVehicles = 16;
        std::vector<Vehicle*> found{start};
        for (std::size_t k = 0; k < found.size(); ++k) {
            Vehicle* crossing = nullptr;
            for (Vehicle* const v : in_path(*found[k])) {
                if (connection_of(*v) == area.other && front_m(*v) <= area.other_from_m) crossing = v;
                if (found.size() < kMaxVehicles && std::find(found.begin(), found.end(), v) == found.end())
                    found.push_back(v);
            }
            if (crossing != nullptr) return crossing;
        }
        return nullptr;
    }

    // Returns the slow vehicles in the path of a vehicle: those in the conflict areas ahead, and the leader in a queue.
    std::vector<Vehicle*> in_path(const Vehicle& v) const {
        std::vector<Vehicle*> found;
        if (connection_of(v) < 0) return found;
        for (const Conflict& conflict : conflicts(connection_of(v))) {
            if (conflict.from_m < front_m(v)) continue;
            for (Vehicle* const other : slow_in_area(conflict)) found.push_back(other);
        }
        const Vehicle* const leader = is_blocked_by_leader(w_, v) ? queue_leader(w_, v) : nullptr;
        if (leader != nullptr) found.push_back(const_cast<Vehicle*>(leader));
        return found;
    }

    // Returns the connection of this intersection that the vehicle is on or takes next; -1: none.
    int connection_of(const Vehicle& v) const {
        const auto intersection = [&](int lane) { return w_.intersection_of[static_cast<std::size_t>(lane)]; };
        if (intersection(v.lane) != intersection(c_.connection)) return -1;
        if (w_.lane_of(v).is_connection()) return v.lane;
        return v.next_lane >= 0 && w_.lane(v.next_lane).origin == v.lane ? v.next_lane : -1;
    }

    double front_m(const Vehicle& v) const {
        return v.position_m - (w_.lane_of(v).is_connection() ? 0.0 : w_.lane_of(v).length_m);
    }

    World& w_;
    const Candidate& c_;
    double margin_m_;
    KeptOutArea area_;
};

}  // namespace stopline::reference_engine
