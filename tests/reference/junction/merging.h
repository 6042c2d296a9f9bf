// Merging and stop signs of imported networks in the reference engine. The rules are those of the comments in
// core/sim/junction/merging.h and stop_signs.h.
#pragma once

#include "reference/junction/candidate.h"

namespace stopline::reference_engine {

class Merging {
public:
    explicit Merging(World& world) : w_(world) {}

    // Returns true if both connections lead to the same exit lane.
    bool is_merge(int connection, const Conflict& conflict) const {
        return w_.is_imported && w_.lane(connection).exit == w_.lane(conflict.other).exit;
    }

    // Returns true if the candidate goes before a vehicle of the other connection, whose front is at `other_front_m`.
    bool goes_first(const Candidate& c, const Conflict& conflict, const Vehicle& other, double other_front_m) const {
        const double own_m = to_exit_m(c.connection, c.front_m);
        const double other_m = to_exit_m(conflict.other, other_front_m);
        const bool is_in_area = c.front_m > conflict.from_m;
        const bool other_is_in_area = other_front_m > conflict.other_from_m;
        if (is_in_area && other_is_in_area) return own_m < other_m || (own_m == other_m && c.vehicle->id < other.id);
        if (is_in_area) return true;
        return other_is_in_area && own_m + c.vehicle->length_m <= other_m;
    }

    // Returns the position where the candidate must be able to stop behind a vehicle that merges ahead of it: one
    // standstill gap before the place where the rear of that vehicle would come to rest.
    double stop_m(const Candidate& c, const Conflict& conflict, const Vehicle& other, double other_front_m) const {
        const double gap_m =
            to_exit_m(c.connection, c.front_m) - to_exit_m(conflict.other, other_front_m) - other.length_m;
        const double braking_m = w_.is_meso ? comfortable_braking_m(w_.driver(other), other.speed_mps)
                                            : emergency_braking_m(w_, other.speed_mps);
        const double behind_m = c.front_m + gap_m - w_.kind(*c.vehicle).standstill_gap_m + braking_m;
        if (c.front_m > conflict.from_m) return behind_m;
        const double before_m = conflict.from_m - w_.driver(*c.vehicle).give_way.margin_m;
        return gap_m < kMinGap_m ? before_m : std::max(behind_m, before_m);
    }

    // Zipper: the vehicles of both connections merge in the order of their distances to the exit lane. Returns the wait
    // behind the last vehicle of the other connection that is ahead in this order.
    Wait zipper_wait(const Candidate& c, const Conflict& conflict) const {
        const double own_m = to_exit_m(c.connection, c.front_m);
        Lane& connection = w_.lane(conflict.other);
        Lane& approach = w_.lane(connection.origin);
        Vehicle* leader = nullptr;
        double leader_front_m = 0.0;
        const auto search = [&](Lane& on, double start_m) {
            for (Vehicle& v : on.vehicles) {
                const double front_m = start_m + v.position_m;
                const double other_m = to_exit_m(conflict.other, front_m);
                if (other_m > own_m || (other_m == own_m && v.id > c.vehicle->id)) return;
                const bool takes_other = on.is_connection() || v.next_lane == conflict.other;
                const bool stops_at_line =
                    v.lane == approach.number && static_cast<std::ptrdiff_t>(v.index) == approach.stop_index;
                if (!takes_other || stops_at_line || is_yielding(w_, v)) continue;
                leader = &v;
                leader_front_m = front_m;
            }
        };
        // A vehicle with its front on the exit lane can have its rear on the other connection.
        for (const Occupant& occupant : w_.occupants[static_cast<std::size_t>(conflict.other)]) {
            if (occupant.front_m <= connection.length_m || (leader != nullptr && occupant.front_m >= leader_front_m))
                continue;
            const double gap_m = own_m - to_exit_m(conflict.other, occupant.front_m) - occupant.vehicle->length_m;
            if (gap_m >= kMinGap_m && c.front_m <= conflict.from_m) continue;  // there is room to enter
            leader = occupant.vehicle;
            leader_front_m = occupant.front_m;
        }
        search(connection, 0.0);
        search(approach, -approach.length_m);
        if (leader == nullptr) return {};
        return {stop_m(c, conflict, *leader, leader_front_m), leader, WaitReason::merging};
    }

    // Returns the wait for a stop sign: each vehicle first stops at the line. At an all-way stop, the vehicles then go
    // in the order of their stops. `line_m`: waiting position at the line.
    Wait stop_sign_wait(const Candidate& c, double line_m) {
        constexpr double kAtLine_m = 2.0;
        const StopRule rule = w_.lane(c.connection).stop_rule;
        Vehicle& v = *c.vehicle;
        if (rule == StopRule::none || c.is_inside) return {};
        if (v.line_stop_tick < 0) {
            if (v.speed_mps >= kStoppedSpeed_mps || line_m - c.front_m >= kAtLine_m)
                return {line_m, nullptr, WaitReason::stop_sign};
            v.line_stop_tick = w_.tick;
            ++w_.situations.stop_signs;
        }
        if (rule != StopRule::all_way_stop) return {};
        for (const Conflict& conflict : w_.lane(c.connection).conflicts) {
            if (w_.lane(conflict.other).stop_rule != StopRule::all_way_stop) continue;
            Vehicle* const other = stopped_at_line(conflict.other);
            if (other == nullptr) continue;
            const bool was_earlier = std::pair(other->line_stop_tick, other->id) < std::pair(v.line_stop_tick, v.id);
            if (was_earlier && !may_accompany(c.connection, conflict.other, v.line_stop_tick))
                return {line_m, other, WaitReason::priority};
        }
        return {};
    }

private:
    double to_exit_m(int connection, double front_m) const { return w_.lane(connection).length_m - front_m; }

    // Returns the first vehicle before the line of a connection's approach lane, if it takes the connection and has
    // stopped for the stop sign; else null.
    Vehicle* stopped_at_line(int connection) const {
        Lane& approach = w_.lane(w_.lane(connection).origin);
        for (Vehicle& v : approach.vehicles) {
            if (v.position_m > approach.stop_line_m) continue;
            const bool goes = v.next_lane == connection && v.line_stop_tick >= 0 &&
                              static_cast<std::ptrdiff_t>(v.index) != approach.stop_index;
            return goes ? &v : nullptr;
        }
        return nullptr;
    }

    // Returns true if a third vehicle has just started that conflicts with connection `next` but not with `connection`,
    // after a stop at `stop_tick`.
    bool may_accompany(int connection, int next, std::int64_t stop_tick) const {
        constexpr double kJustStarted_s = 2.0;
        for (const Conflict& third : w_.lane(next).conflicts) {
            const auto is_third = [&](const Conflict& own) { return own.other == third.other; };
            const std::vector<Conflict>& own = w_.lane(connection).conflicts;
            if (third.other == connection || std::any_of(own.begin(), own.end(), is_third)) continue;
            for (const Occupant& occupant : w_.occupants[static_cast<std::size_t>(third.other)]) {
                const double since_s = static_cast<double>(w_.tick - occupant.since) * w_.step_s;
                if (occupant.since >= stop_tick && since_s <= kJustStarted_s) return true;
            }
        }
        return false;
    }

    static constexpr double kMinGap_m = 0.5;  // smallest net gap at which a candidate enters the conflict area

    World& w_;
};

}  // namespace stopline::reference_engine
