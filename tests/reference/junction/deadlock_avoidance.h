// Deadlock avoidance of the reference engine: a vehicle does not enter a conflict area if its body would complete a
// cycle of vehicles that block each other.
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
            for (const Link& blocker : holders(conflict)) check_stop(conflict.from_m - margin_m_, blocker);
        }
        const Occupant* nearest = nullptr;
        for (const Occupant& leader : w_.occupants[static_cast<std::size_t>(c_.connection)]) {
            if (leader.rear_m < c_.front_m) continue;
            nearest = &leader;
            if (leader.vehicle->is_slow())
                check_stop(leader.rear_m - w_.kind(*c_.vehicle).standstill_gap_m, {leader.vehicle});
        }
        if (nearest != nullptr && !nearest->vehicle->is_slow()) check_stop_behind(*nearest->vehicle);
        return area_;
    }

private:
    // A vehicle that blocks another one if it stops with its front between two positions on its connection.
    struct Link {
        Vehicle* vehicle = nullptr;
        double from_m = -kNoLimit;
        double to_m = kNoLimit;

        bool blocks_from(double front_m) const { return front_m > from_m && front_m < to_m; }
        bool operator==(const Link&) const = default;
    };

    const std::vector<Conflict>& conflicts(int connection) const { return w_.lane(connection).conflicts; }

    bool brakes_for(const Vehicle& v, double area_m) const {
        return v.yield_tick >= w_.tick - 1 && stored(v.yield_position_m) <= stored(area_m);
    }

    // Returns true if the vehicle can stop before an area. A slow vehicle may use the margin. In full dynamics, the
    // vehicle keeps its present acceleration until the brake responds.
    bool can_stop(const Vehicle& v, double distance_m) const {
        const double room_m = distance_m - (v.is_slow() ? 0.0 : w_.driver(v).give_way.margin_m);
        if (w_.is_meso) return emergency_braking_m(w_, v.speed_mps) <= room_m;
        const CaccSettings& cacc = w_.driver(v).cacc;
        const double present_mps2 = std::max(v.acceleration_mps2, 0.0);
        const double change_mps2 = std::max(present_mps2, v.request_mps2) + cacc.deceleration_emergency_mps2;
        const double delay_s = w_.kind(v).vehicle.settings.brake_lag_s + 0.5 * change_mps2 / cacc.jerk_down_mps3;
        const double speed_mps = v.speed_mps + present_mps2 * delay_s;
        const double delay_m = (v.speed_mps + 0.5 * present_mps2 * delay_s) * delay_s;
        return speed_mps * speed_mps <= 2.0 * cacc.deceleration_emergency_mps2 * (room_m - delay_m);
    }

    // Returns true if the vehicle waits or can still wait before the area that starts at `area_m`.
    bool can_wait_before(const Vehicle& v, double front_m, double area_m) const {
        return front_m <= area_m && (brakes_for(v, area_m) || can_stop(v, area_m - front_m));
    }

    // Returns true if the vehicle is past the start of the area or can no longer stop before it. Of two vehicles that
    // can stop for the last time in this step, the candidate sees only the one with the lower id as unable to stop.
    bool must_enter(const Vehicle& v, double front_m, double area_m) const {
        if (!can_wait_before(v, front_m, area_m)) return true;
        if (v.id > c_.vehicle->id || brakes_for(v, area_m)) return false;
        const double soon_mps = v.speed_mps + 0.3 * std::max(v.acceleration_mps2, 0.0);
        return !can_stop(v, area_m - front_m - (0.3 + 2.0 * w_.step_s) * soon_mps);
    }

    // Returns the vehicles of connection `conflict.other` that can block the area. A slow vehicle in the area blocks it
    // in any case. Another vehicle that is in the area, or must enter it, blocks it if it stops there.
    std::vector<Link> holders(const Conflict& conflict) const {
        std::vector<Link> found;
        const auto add_if_it_enters = [&](Vehicle& v, double front_m) {
            if (!must_enter(v, front_m, conflict.other_from_m)) return false;
            found.push_back({&v, conflict.other_from_m, conflict.other_to_m + v.length_m});
            return true;
        };
        for (const Occupant& other : w_.occupants[static_cast<std::size_t>(conflict.other)]) {
            Vehicle& v = *other.vehicle;
            if (other.rear_m >= conflict.other_to_m || &v == c_.vehicle) continue;
            if (v.is_slow() && other.front_m > conflict.other_from_m) {
                found.push_back({&v});
            } else {
                add_if_it_enters(v, other.front_m);
            }
        }
        Lane& approach = w_.lane(w_.lane(conflict.other).origin);
        for (Vehicle& v : approach.vehicles) {
            if (static_cast<std::ptrdiff_t>(v.index) == approach.stop_index) break;
            if (v.position_m > approach.stop_line_m) continue;
            const double front_m = v.position_m - approach.length_m;
            if (!must_enter(v, front_m, conflict.other_from_m)) break;
            if (v.next_lane == conflict.other && &v != c_.vehicle) add_if_it_enters(v, front_m);
        }
        return found;
    }

    // Checks the areas that the candidate would block if it stopped at `place_m` because of `blocker`. Before the first
    // area that closes a cycle the candidate would stop, too.
    void check_stop(double place_m, const Link& blocker) {
        for (const Conflict& area : conflicts(c_.connection)) {
            if (area.from_m >= std::min(place_m, area_.from_m)) continue;
            if (area.to_m <= place_m - c_.vehicle->length_m) continue;
            if (closes_cycle(area, blocker)) return;
        }
    }

    // Checks the areas that the candidate would block behind its leader, which is not slow.
    void check_stop_behind(Vehicle& leader) {
        const double behind_m = leader.length_m + w_.kind(*c_.vehicle).standstill_gap_m;
        for (const Conflict& area : conflicts(c_.connection)) {
            if (area.from_m >= area_.from_m) continue;
            const double last_m = area.to_m + c_.vehicle->length_m;
            if (closes_cycle(area, {&leader, area.from_m + behind_m, last_m + behind_m})) return;
        }
    }

    bool closes_cycle(const Conflict& area, const Link& blocker) {
        if (!can_wait_before(*c_.vehicle, c_.front_m, area.from_m)) return false;
        Vehicle* const crossing = find_crossing(area, blocker);
        if (crossing == nullptr) return false;
        area_ = {area.from_m, crossing};
        check_stop(area.from_m - margin_m_, {crossing});
        return true;
    }

    // Returns a vehicle that must still cross the area and that is in the path of `start`, directly or through further
    // vehicles; null: none.
    Vehicle* find_crossing(const Conflict& area, const Link& start) const {
        constexpr std::size_t kMaxLinks = 24;
        std::vector<Link> found{start};
        for (std::size_t k = 0; k < found.size(); ++k) {
            Vehicle* crossing = nullptr;
            for (const Link& next : next_links(Link(found[k]))) {
                if (connection_of(*next.vehicle) == area.other && waits_before(next, area.other_from_m))
                    crossing = next.vehicle;
                if (found.size() < kMaxLinks && std::find(found.begin(), found.end(), next) == found.end())
                    found.push_back(next);
            }
            if (crossing != nullptr) return crossing;
        }
        return nullptr;
    }

    // Returns true if the vehicle can still wait before the area and then blocks the previous vehicle.
    bool waits_before(const Link& link, double area_m) const {
        const Vehicle& v = *link.vehicle;
        const double place_m = area_m - w_.driver(v).give_way.margin_m;
        return can_wait_before(v, front_m(v), area_m) && link.blocks_from(std::max(front_m(v), place_m));
    }

    // Returns the vehicles that block a vehicle: those in the conflict areas ahead, and the leader.
    std::vector<Link> next_links(const Link& link) const {
        std::vector<Link> found;
        const Vehicle& v = *link.vehicle;
        if (connection_of(v) < 0) return found;
        for (const Conflict& conflict : conflicts(connection_of(v))) {
            if (!waits_before(link, conflict.from_m)) continue;
            const std::vector<Link> of_area = holders(conflict);
            found.insert(found.end(), of_area.begin(), of_area.end());
        }
        if (v.is_slow()) {
            const Vehicle* const leader = is_blocked_by_leader(w_, v) ? queue_leader(w_, v) : nullptr;
            if (leader != nullptr) found.push_back({const_cast<Vehicle*>(leader)});
            return found;
        }
        Vehicle* leader = nullptr;
        for (const Occupant& ahead : w_.occupants[static_cast<std::size_t>(connection_of(v))]) {
            if (ahead.rear_m >= front_m(v)) leader = ahead.vehicle;
        }
        if (leader == nullptr || leader == c_.vehicle) return found;
        const double behind_m = leader->length_m + w_.kind(v).standstill_gap_m;
        found.push_back({leader, link.from_m + behind_m, link.to_m + behind_m});
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
