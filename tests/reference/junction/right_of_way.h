// Right of way of the reference engine: who waits, and before which conflict area. The rules are those of the comments
// in core/sim/junction/right_of_way.cpp.
#pragma once

#include <tuple>

#include "reference/junction/deadlock_avoidance.h"
#include "reference/junction/deadlocks.h"
#include "reference/junction/gap_acceptance.h"

namespace stopline::reference_engine {

class RightOfWay {
public:
    explicit RightOfWay(World& world)
        : w_(world), merging_(world), gaps_(world, resolutions_), deadlocks_(world, resolutions_) {}

    // Sets the right of way of the present phase of each signal.
    void update_phases() {
        for (const PhasePriority& changing : w_.model.phase_priorities) {
            const Priority now = changing.at(w_.tick);
            const Priority before = changing.at(w_.tick - 1);
            if (w_.tick > 0 && now == before) continue;
            set_priority(changing.first(), changing.second(), now.first_yields, now.second_yields);
            set_priority(changing.second(), changing.first(), now.second_yields, now.first_yields);
            if (now.first_yields && !before.first_yields) keep_priority(changing.first(), changing.second());
            if (now.second_yields && !before.second_yields) keep_priority(changing.second(), changing.first());
        }
    }

    // Sets Lane::yield_stops. To be called after the decisions at the stop lines.
    void decide() {
        resolutions_.forget_unused(w_.tick);
        for (Lane& lane : w_.lanes) lane.yield_stops.clear();
        std::vector<std::vector<Vehicle*>> approaching(w_.lanes.size());
        for (const std::size_t number : w_.order) {
            if (w_.lanes[number].signal_group >= 0) list_approaching(w_.lanes[number], approaching);
        }
        for (const std::size_t number : w_.order) {
            Lane& connection = w_.lanes[number];
            if (!connection.is_connection() || connection.conflicts.empty()) continue;
            Vehicle* ahead = nullptr;
            for (Vehicle& v : connection.vehicles) {
                const bool is_inside = true;
                decide_candidate({&v, connection.number, v.position_m, is_inside}, 0.0, ahead);
            }
            const Lane& origin = w_.lane(connection.origin);
            for (Vehicle* const v : approaching[number]) {
                const Candidate candidate{v, connection.number, v->position_m - origin.length_m,
                                          v->position_m > origin.stop_line_m};
                decide_candidate(candidate, -origin.length_m, ahead);
            }
        }
    }
    // To be called when all yield stops of the step are known.
    void resolve_deadlocks() { deadlocks_.resolve(); }

private:
    void set_priority(int connection, int other, bool yields, bool other_yields) {
        for (Conflict& conflict : w_.lane(connection).conflicts) {
            if (conflict.other == other)
                std::tie(conflict.yields, conflict.other_yields) = std::pair(yields, other_yields);
        }
    }

    // A connection begins to yield. Vehicles that can no longer stop before the conflict area still go first.
    void keep_priority(int connection, int other) {
        for (const Conflict& conflict : w_.lane(connection).conflicts) {
            if (conflict.other != other) continue;
            Lane& origin = w_.lane(w_.lane(connection).origin);
            const auto check = [&](Vehicle& v, double start_m) {
                const DriverSettings& driver = w_.driver(v);
                const double room_m = conflict.from_m - driver.give_way.margin_m - start_m - v.position_m;
                if (comfortable_stop_m(w_, driver, v.speed_mps) > room_m) v.accepted_gap_on = connection;
            };
            for (Vehicle& v : w_.lane(connection).vehicles) check(v, 0.0);
            for (Vehicle& v : origin.vehicles) {
                if (v.next_lane == connection) check(v, -origin.length_m);
            }
        }
    }

    bool has_occupants(int connection) const { return !w_.occupants[static_cast<std::size_t>(connection)].empty(); }
    bool has_crossing_occupants(const Lane& connection) const {
        return std::any_of(connection.conflicts.begin(), connection.conflicts.end(),
                           [&](const Conflict& conflict) { return has_occupants(conflict.other); });
    }

    // Lists the vehicles of an approach lane, by connection, for which right of way must be decided.
    void list_approaching(Lane& approach, std::vector<std::vector<Vehicle*>>& approaching) const {
        const double look_back_m = w_.is_imported ? 160.0 : 60.0;
        for (Vehicle& v : approach.vehicles) {
            const double to_end_m = approach.length_m - v.position_m;
            if (to_end_m > look_back_m || static_cast<std::ptrdiff_t>(v.index) == approach.stop_index) return;
            if (v.next_lane < 0 || w_.lane(v.next_lane).origin != approach.number) continue;
            const Lane& connection = w_.lane(v.next_lane);
            if (connection.conflicts.empty()) continue;
            // A vehicle with priority need not decide while nobody is on a conflicting connection.
            if (!w_.is_imported && !connection.yields && !has_crossing_occupants(connection)) continue;
            const DriverSettings& driver = w_.driver(v);
            double to_stop_m = to_end_m + connection.first_conflict_m - driver.give_way.margin_m;
            if (!connection.waits_inside || connection.stop_rule != StopRule::none)
                to_stop_m = std::min(to_stop_m, approach.stop_line_m - driver.stop.margin_m - v.position_m);
            const bool is_far = to_stop_m > decision_distance_m(driver, v.speed_mps);
            if (is_far && !(connection.yields && v.accepted_gap_on == v.next_lane)) continue;
            approaching[static_cast<std::size_t>(v.next_lane)].push_back(&v);
        }
    }

    // Decides for a candidate, and adds its yield stop. `start_m`: start of its lane, from the start of the connection.
    // `ahead`: the nearest waiting vehicle ahead on the way to the connection; the candidate replaces it if it waits.
    void decide_candidate(const Candidate& c, double start_m, Vehicle*& ahead) {
        Wait wait = search(c, ahead);
        if (!wait.exists()) return;
        Vehicle& v = *c.vehicle;
        if (w_.is_imported) wait.place_m = clear_place_m(c, wait.place_m);
        const int blocker_id = wait.blocker == nullptr ? -1 : wait.blocker->id;
        w_.lane_of(v).add_yield_stop({v.index, wait.place_m - start_m, blocker_id, wait.reason});
        if (wait.reason == WaitReason::merging) {
            ++w_.situations.merged;
            return;
        }
        ahead = &v;
        if (!wait.keeps_gap && may_drop_gap(c, wait)) v.accepted_gap_on = -1;
        w_.situations.yielded += v.yield_tick < w_.tick - 1 ? 1 : 0;
        if (v.yield_tick < w_.tick - 1 || !v.is_slow()) v.wait_since_tick = w_.tick;
        v.yield_tick = w_.tick;
        v.yield_position_m = wait.place_m;
        v.yield_reason = wait.reason;
    }

    // Returns true if a waiting candidate is stopped or can still stop, before all areas where it must yield.
    bool may_drop_gap(const Candidate& c, const Wait& wait) const {
        const DriverSettings& driver = w_.driver(*c.vehicle);
        double room_m = wait.place_m - c.front_m;
        for (const Conflict& conflict : w_.lane(c.connection).conflicts) {
            if (conflict.yields && conflict.from_m >= c.front_m)
                room_m = std::min(room_m, conflict.from_m - driver.give_way.margin_m - c.front_m);
        }
        return c.is_stopped() || comfortable_stop_m(w_, driver, c.vehicle->speed_mps) <= room_m;
    }

    // The positions where a candidate can wait.
    struct Places {
        double line_m = kNoLimit;  // at the stop line; infinity: the candidate waits before the conflict area
        double margin_m = 0.0;
        double decision_m = 0.0;  // distance to a place within which the candidate decides

        bool is_line() const { return line_m < kNoLimit; }
        double before_m(const Conflict& conflict) const { return conflict.from_m - margin_m; }
        double at_m(const Conflict& conflict) const { return std::min(before_m(conflict), line_m); }
    };

    Wait search(const Candidate& c, Vehicle* ahead) {
        Vehicle& v = *c.vehicle;
        const Lane& connection = w_.lane(c.connection);
        const Lane& origin = w_.lane(connection.origin);
        const DriverSettings& driver = w_.driver(v);
        // A vehicle behind a stopped leader cannot use its gap.
        if (c.is_stopped() && is_blocked_by_leader(w_, v)) v.accepted_gap_on = -1;
        const double to_first_m = connection.first_conflict_m - driver.give_way.margin_m - c.front_m;
        const bool checks_again = !c.is_stopped() && to_first_m > comfortable_braking_m(driver, v.speed_mps);
        bool has_gap = v.accepted_gap_on == c.connection && !checks_again;
        const double line_m = origin.stop_line_m - origin.length_m - driver.stop.margin_m;
        const Places places{waits_at_line(c, line_m) ? line_m : kNoLimit, driver.give_way.margin_m,
                            decision_distance_m(driver, v.speed_mps)};
        if (places.is_line() && line_m - c.front_m > places.decision_m) return {};
        if (w_.is_imported) {
            if (const Wait wait = merging_.stop_sign_wait(c, line_m); wait.exists()) return wait;
        }
        const bool was_waiting = c.is_stopped() || v.yield_tick >= w_.tick - 1;
        const bool checks_committed = was_waiting || w_.is_imported;
        const bool has_others = has_crossing_occupants(connection);
        if (!has_others && !checks_committed && (has_gap || !connection.yields)) return {};
        const bool avoids_deadlocks = w_.model.rules.keep_clear && w_.scenario.rules.pass_blocker_greens == 0.0;
        const KeptOutArea kept_out = avoids_deadlocks ? DeadlockAvoidance(w_, c).area() : KeptOutArea{};
        if (kept_out.crossing != nullptr && c.is_stopped()) has_gap = false;
        Wait behind;  // nearest place behind a vehicle that the candidate may follow
        for (const Conflict& conflict : connection.conflicts) {
            const bool merges = merging_.is_merge(c.connection, conflict);
            if (c.front_m > (merges ? conflict.to_m : conflict.from_m)) continue;
            const bool is_far = places.before_m(conflict) - c.front_m > places.decision_m;
            const bool is_beyond_decision = is_far && !places.is_line();
            if (is_beyond_decision && !w_.is_imported) break;
            if (conflict.from_m >= kept_out.from_m && !is_beyond_decision)
                return nearer({places.at_m(conflict), kept_out.crossing, WaitReason::deadlock}, behind);
            if (merges) {
                if (!is_beyond_decision) behind = nearer(behind, merging_wait(c, conflict, was_waiting));
            } else if (const Wait wait = area_wait(c, conflict, places, was_waiting, is_far); wait.exists()) {
                if (!clears_in_time(c, conflict, places, *wait.blocker)) return nearer(wait, behind);
                behind = nearer(behind, {places.before_m(conflict), wait.blocker, WaitReason::merging});
            }
            if (!conflict.yields || has_gap || is_beyond_decision || c.front_m > conflict.from_m) continue;
            const GapBlocker blocker = kept_out.crossing != nullptr
                                           ? GapBlocker{kept_out.crossing, WaitReason::deadlock}
                                       : ahead != nullptr ? GapBlocker{ahead}
                                                          : gap_blocker(c, conflict, places);
            if (blocker.vehicle != nullptr)
                return nearer({places.at_m(conflict), blocker.vehicle, blocker.reason}, behind);
            has_gap = true;
        }
        return behind;
    }

    GapBlocker gap_blocker(const Candidate& c, const Conflict& conflict, const Places& places, double delay_s = 0.0) {
        return gaps_.blocker(c, w_.is_imported ? places.at_m(conflict) : places.before_m(conflict), delay_s);
    }

    // Returns true if the candidate may wait at the stop line only, and can still stop there.
    bool waits_at_line(const Candidate& c, double line_m) const {
        const Vehicle& v = *c.vehicle;
        if (c.is_inside || w_.lane(c.connection).waits_inside) return false;
        const DriverSettings& driver = w_.driver(v);
        if (c.is_stopped() || line_m - c.front_m >= comfortable_braking_m(driver, v.speed_mps)) return true;
        const bool brakes_for_line = v.yield_tick >= w_.tick - 1 && stored(v.yield_position_m) <= stored(line_m);
        return brakes_for_line && line_m + driver.stop.margin_m - c.front_m >= emergency_braking_m(w_, v.speed_mps);
    }

    // Returns the wait for a vehicle that is in the conflict area or enters it; no wait if there is no such vehicle, or
    // if the area is so far that it can wait.
    Wait area_wait(const Candidate& c, const Conflict& conflict, const Places& places, bool was_waiting, bool is_far) {
        Vehicle* blocker = nullptr;
        for (const Occupant& other : w_.occupants[static_cast<std::size_t>(conflict.other)]) {
            if (!blocks_area(c, conflict, other)) continue;
            blocker = other.vehicle;
            break;
        }
        if (blocker == nullptr && (was_waiting || w_.is_imported))
            blocker = committed_blocker(c, conflict, was_waiting);
        if (blocker == nullptr) return {};
        const bool has_no_signal = w_.group_of_connection(c.connection) == 0;
        const bool checks_all = has_no_signal && (places.is_line() || !w_.is_imported);
        if (is_far && !checks_all && !blocker->is_slow()) return {};
        Wait wait{places.at_m(conflict), blocker, WaitReason::occupied};
        if (conflict.other_yields) wait.reason = WaitReason::intruder;
        if (conflict.yields && c.is_stopped() && !blocker->is_slow())
            wait.keeps_gap = gap_blocker(c, conflict, places, w_.step_s).vehicle == nullptr;
        return wait;
    }

    // Returns true if an occupant of the other connection keeps the candidate out of the conflict area.
    bool blocks_area(const Candidate& c, const Conflict& conflict, const Occupant& other) {
        Vehicle& own_vehicle = *c.vehicle;
        Vehicle& other_vehicle = *other.vehicle;
        if (other.rear_m >= conflict.other_to_m) return false;
        if (other.front_m > conflict.other_from_m) return true;
        const Lane& others_lane = w_.lane_of(other_vehicle);
        const bool stops_at_line = others_lane.number == w_.lane(conflict.other).origin &&
                                   static_cast<std::ptrdiff_t>(other_vehicle.index) == others_lane.stop_index;
        if (stops_at_line || conflict.yields) return false;
        if (conflict.other_yields)
            return other_vehicle.accepted_gap_on == conflict.other &&
                   !is_yielding_before(w_, other_vehicle, conflict.other_from_m);
        // Neither has priority. If only one of the two vehicles can stop before the area, it waits.
        const bool can_stop = can_stop_within(own_vehicle, conflict.from_m - c.front_m);
        const bool other_can_stop = can_stop_within(other_vehicle, conflict.other_from_m - other.front_m);
        if (can_stop != other_can_stop) return can_stop;
        if (resolutions_.find(other_vehicle, own_vehicle) != nullptr) return true;
        if (Resolution* const known = resolutions_.find(own_vehicle, other_vehicle)) {
            known->last_tick = w_.tick;
            return false;
        }
        if (c.is_stopped() &&
            (is_yielding(w_, other_vehicle) || is_behind_yielding_vehicle(w_, conflict.other, other))) {
            resolutions_.add(own_vehicle, other_vehicle, w_.tick);
            return false;
        }
        const std::int64_t since = own_vehicle.entry_tick;
        return !c.is_inside || other.since < since ||
               (other.since == since && w_.is_before(other_vehicle, own_vehicle));
    }

    bool can_stop_within(const Vehicle& v, double distance_m) const {
        constexpr double kResponse_s = 0.3;
        return emergency_braking_m(w_, v.speed_mps) + (w_.is_meso ? 0.0 : kResponse_s * v.speed_mps) <= distance_m;
    }

    // Returns a vehicle without priority for which the candidate must wait because it can no longer stop; null if there
    // is none, or if the candidate cannot stop either.
    Vehicle* committed_blocker(const Candidate& c, const Conflict& conflict, bool was_waiting) const {
        if (!conflict.other_yields || conflict.from_m - c.front_m < emergency_braking_m(w_, c.vehicle->speed_mps))
            return nullptr;
        Vehicle* const committed = gaps_.committed_vehicle(conflict);
        if (committed == nullptr) return nullptr;
        return was_waiting || gaps_.occupies_area_on_arrival(c, conflict, *committed) ? committed : nullptr;
    }

    // Returns true if an occupant of a connection has just had to wait, or may have to wait at the next intersection
    // before its rear leaves the connection.
    bool may_have_to_wait(int connection, const Occupant& other) const {
        const Lane& lane = w_.lane(connection);
        if (other.front_m <= lane.length_m) return other.vehicle->yield_tick >= w_.tick - 1;
        return w_.lane(lane.exit).stop_line_m < w_.longest_space_m();
    }

    // Returns true if a candidate that may wait at its line only need not wait there, because all vehicles of the other
    // connection leave the area before it arrives.
    bool clears_in_time(const Candidate& c, const Conflict& conflict, const Places& places,
                        const Vehicle& blocker) const {
        if (!places.is_line() || blocker.is_slow()) return false;
        const double in_s = earliest_arrival_s(places.before_m(conflict) - c.front_m, c.vehicle->speed_mps,
                                               w_.driver(*c.vehicle).give_way.approach_acceleration_mps2,
                                               w_.lane(c.connection).limit_mps);
        for (const Occupant& other : w_.occupants[static_cast<std::size_t>(conflict.other)]) {
            if (other.rear_m >= conflict.other_to_m) continue;
            const bool may_stop = other.vehicle->is_slow() || may_have_to_wait(conflict.other, other);
            if (may_stop || (conflict.other_to_m - other.rear_m) / other.vehicle->speed_mps > in_s) return false;
        }
        return true;
    }

    // Returns the wait behind the vehicles that merge into the exit lane ahead of the candidate.
    Wait merging_wait(const Candidate& c, const Conflict& conflict, bool was_waiting) {
        if (conflict.zipper) {
            const Wait wait = merging_.zipper_wait(c, conflict);
            const bool goes_first = wait.blocker != nullptr && resolutions_.find(*c.vehicle, *wait.blocker) != nullptr;
            return goes_first ? Wait{} : wait;
        }
        Wait nearest;
        const auto follow = [&](Vehicle& other, double front_m) {
            if (merging_.goes_first(c, conflict, other, front_m)) return;
            const WaitReason reason = conflict.other_yields ? WaitReason::intruder : WaitReason::merging;
            nearest = nearer(nearest, {merging_.stop_m(c, conflict, other, front_m), &other, reason});
        };
        for (const Occupant& other : w_.occupants[static_cast<std::size_t>(conflict.other)]) {
            if (blocks_area(c, conflict, other)) follow(*other.vehicle, other.front_m);
        }
        if (Vehicle* const committed = committed_blocker(c, conflict, was_waiting))
            follow(*committed, committed->position_m - w_.lane(w_.lane(conflict.other).origin).length_m);
        return nearest;
    }

    // Imported networks: returns the waiting place furthest downstream where the candidate blocks no conflict area with
    // a connection whose signal is green.
    double clear_place_m(const Candidate& c, double place_m) const {
        const DriverSettings& driver = w_.driver(*c.vehicle);
        const double stopping_m =
            c.is_stopped() ? 0.0 : braking_m(c.vehicle->speed_mps, 0.0, driver.cacc.deceleration_comfort_mps2);
        const std::vector<Conflict>& conflicts = w_.lane(c.connection).conflicts;
        for (auto conflict = conflicts.rbegin(); conflict != conflicts.rend(); ++conflict) {
            const bool would_block = conflict->from_m < place_m && conflict->to_m > place_m - c.vehicle->length_m;
            if (!would_block || conflict->from_m - c.front_m < stopping_m) continue;
            if (w_.light(w_.group_of_connection(conflict->other)) == Light::green)
                place_m = conflict->from_m - driver.give_way.margin_m;
        }
        return place_m;
    }

    World& w_;
    Resolutions resolutions_;
    Merging merging_;
    GapAcceptance gaps_;
    Deadlocks deadlocks_;
};

}  // namespace stopline::reference_engine
