// Stop lines of the reference engine: the vehicle that stops for the signal or for the keep-clear rule.
#pragma once

#include "reference/junction/occupants.h"

namespace stopline::reference_engine {

class StopLines {
public:
    explicit StopLines(World& world) : w_(world) {}

    // Sets Lane::stop_index and Lane::is_held of all lanes.
    void decide() {
        for (const std::size_t number : w_.order) {
            Lane& lane = w_.lanes[number];
            if (lane.signal_group < 0) continue;
            lane.stop_index = -1;
            if (lane.vehicles.empty()) continue;
            held_id_ = lane.is_held ? lane.stop_id : -1;
            lane.is_held = false;
            const bool may_hold = lane.has_movement_signals ? !stop_for_movement(lane) : stop_for_signal(lane);
            if (may_hold && w_.model.rules.keep_clear) hold_for_keep_clear(lane);
            lane.stop_id = lane.stop_index < 0 ? -1 : lane.vehicles[static_cast<std::size_t>(lane.stop_index)].id;
        }
    }

    // Returns the highest deceleration with which the vehicle stops for a light.
    double stopping_mps2(const Vehicle& v, Light light) const {
        const DriverSettings& driver = w_.driver(v);
        return light == Light::yellow ? driver.stop.decision_deceleration_mps2
                                      : driver.cacc.deceleration_emergency_mps2;
    }

    // Returns true if the vehicle can stop before a line with the given deceleration. Until the brake responds, the
    // vehicle keeps its present acceleration if this is positive. `line_m`: from the start of the vehicle's lane.
    bool can_stop(const Vehicle& v, double line_m, double deceleration_mps2) const {
        const double present_mps2 = std::max(v.acceleration_mps2, 0.0);
        const double request_mps2 = w_.is_meso ? present_mps2 : std::max(present_mps2, v.request_mps2);
        const double delay_s = w_.kind(v).vehicle.settings.brake_lag_s +
                               0.5 * (request_mps2 + deceleration_mps2) / w_.driver(v).cacc.jerk_down_mps3;
        const double speed_mps = v.speed_mps + present_mps2 * delay_s;
        const double delay_m = (v.speed_mps + 0.5 * present_mps2 * delay_s) * delay_s;
        return speed_mps * speed_mps <= 2.0 * deceleration_mps2 * (line_m - v.position_m - delay_m);
    }

    // Returns true if the vehicle can stop before a line for a light that is not green. Mesoscale mode of imported
    // networks: with maximum braking and without lag at a red light.
    bool can_stop_for(const Vehicle& v, Light light, double line_m) const {
        if (!w_.is_meso || !w_.is_imported || light != Light::red) return can_stop(v, line_m, stopping_mps2(v, light));
        const double hardest_mps2 = w_.model.common_driver().cacc.deceleration_emergency_mps2;
        return v.speed_mps * v.speed_mps <= 2.0 * hardest_mps2 * (line_m - v.position_m);
    }

private:
    // On the last edge of its trip, a vehicle is removed at the line and ignores the signal.
    bool ends_trip_here(const Vehicle& v) const {
        return v.next_lane < 0 && v.trip >= 0 && w_.route_of(v.route).size() == 1;
    }

    // Chooses the vehicle that stops for the signal. The choice holds until the signal is green and the reaction time
    // of the first driver has passed. Returns true if the signal lets all vehicles pass.
    bool stop_for_signal(Lane& lane) {
        const Light light = w_.light(lane.signal_group);
        const auto is_chosen = [&](const Vehicle& v) { return v.id == lane.stopping_id; };
        auto stopper = std::find_if(lane.vehicles.begin(), lane.vehicles.end(), is_chosen);
        if (light == Light::green) {
            const bool have_one_driver = w_.model.drivers.size() == 1;
            const std::int64_t hesitation_ticks = have_one_driver                  ? w_.kinds.front().hesitation_ticks
                                                  : stopper == lane.vehicles.end() ? 0
                                                                                   : w_.kind(*stopper).hesitation_ticks;
            if (lane.stopping_id < 0 || w_.tick >= w_.since(lane.signal_group) + hesitation_ticks) {
                lane.stopping_id = -1;
                return true;
            }
        }
        // A vehicle ahead of the chosen one stops instead if it has become slow enough.
        if (stopper == lane.vehicles.end() || light != Light::green) {
            stopper = std::find_if(lane.vehicles.begin(), lane.vehicles.end(), [&](const Vehicle& v) {
                return is_chosen(v) || (!ends_trip_here(v) && can_stop_for(v, light, lane.stop_line_m));
            });
        }
        lane.stopping_id = -1;
        if (stopper != lane.vehicles.end()) stop(lane, *stopper);
        return false;
    }

    // The same for a lane whose movements have signals of their own. Returns true if a vehicle stops.
    bool stop_for_movement(Lane& lane) {
        const int chosen = std::exchange(lane.stopping_id, -1);
        for (Vehicle& v : lane.vehicles) {
            if (ends_trip_here(v)) continue;
            const int group = w_.group_of(lane, v.next_lane);
            const Light light = w_.light(group);
            const bool hesitates = v.id == chosen && w_.tick < w_.since(group) + w_.kind(v).hesitation_ticks;
            if (light == Light::green && !hesitates) continue;
            if (v.id != chosen && !can_stop_for(v, light, lane.stop_line_m)) continue;
            stop(lane, v);
            return true;
        }
        return false;
    }

    void stop(Lane& lane, Vehicle& v) {
        v.is_platoon_leader = true;
        lane.stopping_id = v.id;
        lane.stop_index = static_cast<std::ptrdiff_t>(v.index);
        // A vehicle that stops past the line enters the intersection only when the stop ends.
        if (v.position_m > lane.stop_line_m) v.entry_tick = w_.tick;
    }

    // Keep-clear rule: stops the first vehicle whose exit lane has no room, or whose path a slow vehicle blocks.
    void hold_for_keep_clear(Lane& lane) {
        constexpr double kDecisionDistance_m = 80.0;
        std::vector<std::pair<int, double>> rooms_m;  // room that is left beyond each connection
        for (const Vehicle& v : lane.vehicles) {
            if (v.position_m < lane.stop_line_m - kDecisionDistance_m) return;
            if (v.next_lane < 0 || w_.lane(v.next_lane).exit < 0 || !w_.lane(v.next_lane).keep_clear) continue;
            const Lane& exit = w_.lane(w_.lane(v.next_lane).exit);
            auto room = std::find_if(rooms_m.begin(), rooms_m.end(),
                                     [&](const auto& known) { return known.first == v.next_lane; });
            if (room == rooms_m.end()) room = rooms_m.insert(room, {v.next_lane, exit_room_m(exit)});
            room->second -= w_.space_m(v);
            if (room->second >= 0.0 && !has_crossing_blocker(w_.lane(v.next_lane)) &&
                !must_wait_for_exit(lane, v, exit))
                continue;
            if (v.position_m > lane.stop_line_m || !can_hold(lane, v)) continue;
            lane.stop_index = static_cast<std::ptrdiff_t>(v.index);
            lane.is_held = true;
            ++w_.situations.held_at_green;
            return;
        }
    }

    // Returns true if a vehicle with priority over the connection is in the intersection and not past the conflict
    // area, or can reach the end of its approach lane within 8 s at the speed limit.
    bool has_priority_traffic(const Lane& connection) const {
        for (const Conflict& conflict : connection.conflicts) {
            if (!conflict.yields) continue;
            const Lane& inside = w_.lane(conflict.other);
            const Lane& approach = w_.lane(inside.origin);
            const auto is_inside = [&](const Vehicle& v) { return v.rear_m() < conflict.other_to_m; };
            const auto is_near = [&](const Vehicle& v) {
                return v.next_lane == conflict.other && approach.length_m - v.position_m <= 8.0 * approach.limit_mps;
            };
            if (std::any_of(inside.vehicles.begin(), inside.vehicles.end(), is_inside)) return true;
            if (std::any_of(approach.vehicles.begin(), approach.vehicles.end(), is_near)) return true;
        }
        return false;
    }

    bool is_short(const Lane& exit) const { return exit.next_limit_m < 3.0 * w_.longest_space_m(); }

    // Returns true if the keep-clear rule applies to the connection, and vehicles are on its short exit lane or on a
    // connection to this lane.
    bool leads_to_used_short_exit(const Lane& connection) const {
        if (!connection.keep_clear || connection.exit < 0 || !is_short(w_.lane(connection.exit))) return false;
        if (!w_.lane(connection.exit).vehicles.empty()) return true;
        const auto& inner = w_.connections_to(connection.exit);
        return std::any_of(inner.begin(), inner.end(), [&](int other) { return !w_.lane(other).vehicles.empty(); });
    }

    // Returns true if the vehicle must let the vehicles ahead leave a short exit lane before it enters. This is so if
    // vehicles may have to stop at the end of the lane, no vehicle on it is slower than 1 m/s, and the lane has no room
    // for the vehicle and all vehicles ahead of it. The last of these must not be stopped on the same approach lane.
    bool must_wait_for_exit(const Lane& approach, const Vehicle& v, const Lane& exit) const {
        if (!is_short(exit) || exit_room_m(exit) < kEndless_m) return false;
        const auto may_stop = [&](int next) {
            const Lane& connection = w_.lane(next);
            return (connection.yields && has_priority_traffic(connection)) || leads_to_used_short_exit(connection) ||
                   (exit.signal_group >= 0 && w_.light(w_.group_of(exit, next)) != Light::green);
        };
        if (std::none_of(exit.next.begin(), exit.next.end(), may_stop)) return false;
        double ahead_m = 0.0;
        const Vehicle* last = nullptr;
        const auto add = [&](const Vehicle& other) {
            ahead_m += w_.space_m(other);
            last = &other;
        };
        for (const Vehicle& other : exit.vehicles) {
            if (other.position_m <= exit.next_limit_m && (other.next_lane < 0 || may_stop(other.next_lane))) add(other);
        }
        for (const int connection : w_.connections_to(exit.number)) {
            std::for_each(w_.lane(connection).vehicles.begin(), w_.lane(connection).vehicles.end(), add);
        }
        for (std::size_t k = 0; k < static_cast<std::size_t>(v.index); ++k) {
            if (approach.vehicles[k].next_lane == v.next_lane) add(approach.vehicles[k]);
        }
        if (last == nullptr || (last->lane == approach.number && last->is_slow())) return false;
        return w_.driver(v).stop.margin_m + ahead_m + v.length_m > exit.next_limit_m;
    }

    // Returns the free length of an exit lane behind its last slow vehicle, minus the space for all vehicles that
    // drive towards this vehicle. If no slow vehicle is in sight, the lane counts as endless. Before a signal that is
    // not green, moving vehicles can count as a queue at its line.
    double exit_room_m(const Lane& exit) const {
        double room_m = kEndless_m;
        double moving_m = 0.0;
        double before_line_m = 0.0;
        for (auto v = exit.vehicles.rbegin(); v != exit.vehicles.rend(); ++v) {
            if (v->rear_m() > w_.model.rules.sight_m) return kEndless_m;
            if (v->is_slow()) {
                room_m = v->rear_m() - moving_m;
                break;
            }
            moving_m += w_.space_m(*v);
            if (v->position_m <= exit.next_limit_m) before_line_m += w_.space_m(*v);
        }
        if (room_m == kEndless_m && queue_ends_at_red(exit)) {
            room_m = exit.next_limit_m - w_.driver(exit.vehicles.front()).stop.margin_m - before_line_m;
        }
        if (room_m == kEndless_m) return room_m;
        for (const int connection : w_.connections_to(exit.number)) {
            for (const Vehicle& inside : w_.lane(connection).vehicles) room_m -= w_.space_m(inside);
        }
        return room_m;
    }

    bool queue_ends_at_red(const Lane& exit) const {
        const RulesPlan& rules = w_.model.rules;
        if (!rules.count_queue_at_red_exit || exit.signal_group < 0 || exit.vehicles.empty()) return false;
        return exit.next_limit_m <= rules.sight_m &&
               w_.light(w_.group_of(exit, exit.vehicles.back().next_lane)) != Light::green;
    }

    // Returns true if a slow vehicle of a crossing street is in a conflict area of the connection. Also returns true if
    // it has waited before the area since an earlier green.
    bool has_crossing_blocker(const Lane& connection) const {
        for (const Conflict& conflict : connection.conflicts) {
            if (conflict.yields || conflict.other_yields) continue;
            const Lane& origin = w_.lane(w_.lane(conflict.other).origin);
            const bool is_red = w_.light(w_.group_of_connection(conflict.other)) == Light::red;
            for (const Occupant& occupant : w_.occupants[static_cast<std::size_t>(conflict.other)]) {
                if (!occupant.vehicle->is_slow() || occupant.rear_m >= conflict.other_to_m) continue;
                if (occupant.front_m > conflict.other_from_m) return true;
                if (is_red && !is_stopper(origin, *occupant.vehicle)) return true;
            }
        }
        return false;
    }
    // Returns true if the vehicle stops at the line by the latest decision. On lanes later in the order of lanes, this
    // is the decision of the previous step.
    static bool is_stopper(const Lane& approach, const Vehicle& v) {
        return v.lane == approach.number && v.id == approach.stop_id;
    }

    // Returns true if the vehicle can still stop at the line for the keep-clear rule, or was held in the previous step.
    bool can_hold(const Lane& lane, const Vehicle& v) const {
        if (v.id == held_id_) return true;
        constexpr double kLagFactor = 1.4;
        const CaccSettings& cacc = w_.driver(v).cacc;
        const double peak_mps2 =
            std::min(kLagFactor * w_.driver(v).stop.deceleration_mps2, cacc.deceleration_emergency_mps2);
        if (peak_mps2 <= cacc.deceleration_comfort_mps2)
            return can_stop(v, lane.stop_line_m, cacc.deceleration_comfort_mps2);
        if (!w_.is_meso) return can_stop(v, lane.stop_line_m, peak_mps2);
        return v.speed_mps * v.speed_mps <= 2.0 * peak_mps2 * (lane.stop_line_m - v.position_m);
    }

    static constexpr double kEndless_m = 1e9;

    World& w_;
    int held_id_ = -1;  // id of the vehicle that the keep-clear rule held on the present lane in the previous step
};

}  // namespace stopline::reference_engine
