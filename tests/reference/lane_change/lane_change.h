// Lane changes of the reference engine. A vehicle decides twice a second. Mandatory changes serve its route,
// discretionary ones its speed (MOBIL). The rules are those of the comments in core/sim/lane_change.
#pragma once

#include "reference/lane_change/request.h"

namespace stopline::reference_engine {

class LaneChanges {
public:
    LaneChanges(World& world, const Routes& routes)
        : w_(world), routes_(routes), perception_(world), gaps_(world), requests_(world, routes) {}

    void change_lanes() {
        const std::int64_t interval_ticks = std::max<std::int64_t>(ticks_in(kDecisionInterval_s, w_.step_s), 1);
        for (const std::size_t number : w_.order) {
            Lane& on = w_.lanes[number];
            if (on.left < 0 && on.right < 0) continue;
            for (std::size_t k = 0; k < on.vehicles.size();) {
                w_.number_vehicles();
                Vehicle& v = on.vehicles[k];
                const bool decides = (w_.tick + v.id) % interval_ticks == 0 && v.change_tick != w_.tick && v.route >= 0;
                if (!decides || !decide(v)) ++k;
            }
        }
    }

private:
    static constexpr double kDecisionInterval_s = 0.5;
    static constexpr double kReturnFactor = 10.0;

    // Returns true if the vehicle has left its lane.
    bool decide(Vehicle& v) {
        constexpr double kMinInterval_s = 2.0;
        const Request me = requests_.of(v);
        remember_speed(v);
        const Lane& on = w_.lane_of(v);
        const double since_change_s = static_cast<double>(w_.tick - v.change_tick) * w_.step_s;
        const Mandatory change = requests_.mandatory(me);
        if (change.changes != 0) {
            const int other = change.changes < 0 ? on.left : on.right;
            return since_change_s >= kMinInterval_s && other >= 0 && change_for_route(me, w_.lane(other), change);
        }
        return since_change_s >= w_.driver(v).lane_change.pause_s && change_for_speed(me);
    }

    // The remembered speed is the highest recent speed. It fades with a time constant of 10 s.
    static void remember_speed(Vehicle& v) {
        constexpr double kMemory_s = 10.0;
        const double faded_mps =
            v.remembered_mps + (v.speed_mps - v.remembered_mps) * (kDecisionInterval_s / kMemory_s);
        v.remembered_mps = stored(std::max(v.speed_mps, faded_mps));
    }

    // Returns true if the whole vehicle is on its lane and fits on the other one, and can still stop before the line.
    bool can_move_beside(const Request& me, const Lane& other) const {
        constexpr double kReaction_s = 0.5;
        const Vehicle& v = *me.vehicle;
        const DriverSettings& driver = w_.driver(v);
        const double stopping_m = comfortable_braking_m(driver, v.speed_mps) + kReaction_s * v.speed_mps;
        return v.position_m >= v.length_m && adjacent_position_m(w_.lane_of(v), v.position_m, other) >= v.length_m &&
               me.to_line_m + driver.stop.margin_m >= stopping_m;
    }

    Neighbours neighbours_on(const Lane& other, const Request& me) const {
        const Vehicle& v = *me.vehicle;
        return gaps_.at(other, adjacent_position_m(w_.lane_of(v), v.position_m, other), v.length_m,
                        routes_.option(other.number, me.turn).route);
    }

    bool gaps_suffice(const Vehicle& v, const Neighbours& there, double share) const {
        const Neighbour& leader = there.leader;
        const Neighbour& follower = there.follower;
        if (leader.vehicle != nullptr &&
            leader.gap_m < gaps_.required_m(v.policy, v.speed_mps, leader.speed_mps(), share))
            return false;
        return follower.vehicle == nullptr ||
               follower.gap_m >= gaps_.required_m(follower.vehicle->policy, follower.speed_mps(), v.speed_mps, share);
    }

    bool change_for_route(const Request& me, Lane& other, const Mandatory& change) {
        if (!can_move_beside(me, other)) return false;
        const Neighbours there = neighbours_on(other, me);
        if (!gaps_suffice(*me.vehicle, there, requests_.gap_share(*me.vehicle, change.urgency()))) return false;
        ++w_.situations.mandatory_changes;
        if (there.index < other.vehicles.size() && other.vehicles[there.index].is_slow()) {
            Vehicle& behind = other.vehicles[there.index];
            const bool had_waited = requests_.has_reached_waiting_position(me);
            (had_waited ? behind.let_in_waiting_tick : behind.let_in_tick) = w_.tick;
            w_.situations.let_in_waiting += had_waited ? 1 : 0;
        }
        move(*me.vehicle, other, there.index);
        return true;
    }

    // Returns true if a lane serves the route as well as the present one, or leaves enough distance to return.
    bool may_change_for_speed(const Request& me, const Lane& other) const {
        const Vehicle& v = *me.vehicle;
        if (!can_move_beside(me, other)) return false;
        if (routes_.later_changes(other.number, v).second > routes_.later_changes(v.lane, v).second) return false;
        const TurnOption option = routes_.option(other.number, me.turn);
        if (option.route >= 0) return true;
        const Lane& on = w_.lane_of(v);
        const double end_m = std::min(v.position_m + me.to_line_m, me.pocket_entry_m);
        const auto vehicles_before_end = [&](const Lane& lane) {
            const auto ahead = [&](double position_m) {
                return static_cast<double>(LaneGaps::vehicles_ahead(lane, adjacent_position_m(on, position_m, lane)));
            };
            return ahead(v.position_m) - ahead(end_m);
        };
        const double vehicles = std::max(vehicles_before_end(on), vehicles_before_end(other));
        const double usable_m = end_m - v.position_m - vehicles * w_.longest_space_m();
        return usable_m > requests_.look_ahead_m(v, option.lane_changes);
    }

    bool change_for_speed(const Request& me) {
        Vehicle& v = *me.vehicle;
        const Lane& on = w_.lane_of(v);
        const LaneChangeSettings& s = w_.driver(v).lane_change;
        const std::array<int, 2> sides{on.right, on.left};
        std::array<bool, 2> may_change{};
        for (std::size_t side = 0; side < 2; ++side)
            may_change[side] = sides[side] >= 0 && may_change_for_speed(me, w_.lane(sides[side]));
        if (!may_change[0] && !may_change[1]) return false;
        const Neighbours here = neighbours_here(v);
        double best_mps = s.gain_mps;
        int chosen = -1;
        std::size_t chosen_index = 0;
        for (std::size_t side = 0; side < 2; ++side) {
            if (!may_change[side]) continue;
            const Neighbours there = neighbours_on(w_.lane(sides[side]), me);
            double& gain_mps = side == 0 ? v.right_gain_mps : v.left_gain_mps;
            add_gain(s, incentive_mps2(v, here, there, side == 0), gain_mps);
            if (gain_mps < best_mps || !gaps_suffice(v, there, s.gap_share)) continue;
            best_mps = gain_mps;
            chosen = sides[side];
            chosen_index = there.index;
        }
        if (chosen < 0) return false;
        ++w_.situations.discretionary_changes;
        move(v, w_.lane(chosen), chosen_index);
        return true;
    }

    Neighbours neighbours_here(const Vehicle& v) const {
        const Lane& on = w_.lane_of(v);
        Neighbours here;
        if (v.index > 0) {
            const Vehicle& ahead = on.vehicles[v.index - 1];
            here.leader = {&ahead, ahead.rear_m() - v.position_m};
        } else {
            const Ahead ahead = perception_.beyond_lane(v, w_.common_driver().cacc.radar_range_m);
            if (ahead.vehicle != nullptr) here.leader = {ahead.vehicle, ahead.rear_m() - v.position_m};
        }
        if (v.index + 1 < on.vehicles.size()) {
            const Vehicle& behind = on.vehicles[v.index + 1];
            here.follower = {&behind, v.rear_m() - behind.position_m};
        }
        return here;
    }

    // Returns the acceleration of the intelligent driver model with the gap of the policy.
    double idm_mps2(const Vehicle& v, double limit_mps, double gap_m, double ahead_mps) const {
        constexpr double kNoLeader_m = 1e5;
        constexpr double kMinAcceleration_mps2 = -9.0;
        const LaneChangeSettings& s = w_.driver(v).lane_change;
        const double free = 1.0 - std::pow(v.speed_mps / limit_mps, 4);
        if (gap_m > kNoLeader_m) return s.acceleration_mps2 * free;
        const double closing_m =
            v.speed_mps * (v.speed_mps - ahead_mps) / (2.0 * std::sqrt(s.acceleration_mps2 * s.deceleration_mps2));
        const double wanted_m = std::max(w_.desired_gap_m(v.policy, v.speed_mps) + closing_m, 0.0);
        const double ratio = wanted_m / std::max(gap_m, 0.1);
        return std::max(s.acceleration_mps2 * (free - ratio * ratio), kMinAcceleration_mps2);
    }

    // Returns the incentive of MOBIL: the own gain in acceleration, and those of the followers times the politeness.
    double incentive_mps2(const Vehicle& v, const Neighbours& here, const Neighbours& there, bool to_the_right) const {
        const LaneChangeSettings& s = w_.driver(v).lane_change;
        const double limit_mps = w_.free_speed_mps(w_.lane_of(v), v.policy);
        const auto own_mps2 = [&](const Neighbour& leader) {
            return idm_mps2(v, limit_mps, leader.gap_m, leader.speed_mps());
        };
        double result = own_mps2(there.leader) - own_mps2(here.leader);
        result += to_the_right ? s.keep_right_mps2 : -s.keep_right_mps2;
        // Returns what a follower loses if `v` drives ahead of it.
        const auto loss_mps2 = [&](const Neighbours& n) {
            if (n.follower.vehicle == nullptr) return 0.0;
            const double joined_m = n.follower.gap_m + v.length_m + n.leader.gap_m;
            return idm_mps2(*n.follower.vehicle, limit_mps, joined_m, n.leader.speed_mps()) -
                   idm_mps2(*n.follower.vehicle, limit_mps, n.follower.gap_m, v.speed_mps);
        };
        if (s.politeness != 0.0) result += s.politeness * (loss_mps2(here) - loss_mps2(there));
        return result;
    }

    // Lets a gain fade, and adds the incentive above the threshold, at most the maximum acceleration. Only the lane
    // that the vehicle has just left can have a negative gain.
    static void add_gain(const LaneChangeSettings& s, double incentive_mps2, double& gain_mps) {
        const double memory_s = gain_mps < 0.0 ? 30.0 : 10.0;
        const double faded_mps = gain_mps * (1.0 - kDecisionInterval_s / memory_s);
        const double counted_mps2 = std::min(incentive_mps2 - s.threshold_mps2, s.acceleration_mps2);
        gain_mps = stored(std::max(faded_mps + counted_mps2 * kDecisionInterval_s, std::min(faded_mps, 0.0)));
    }

    // Moves a vehicle to a place of another lane.
    void move(const Vehicle& vehicle, Lane& other, std::size_t index) {
        Lane& from = w_.lane_of(vehicle);
        const std::size_t old_index = vehicle.index;
        Vehicle v = vehicle;
        from.vehicles.erase(from.vehicles.begin() + static_cast<std::ptrdiff_t>(old_index));
        v.position_m = adjacent_position_m(from, v.position_m, other);
        v.change_tick = w_.tick;
        const double way_back_mps = stored((1.0 - kReturnFactor) * w_.driver(v).lane_change.gain_mps);
        const bool to_the_right = other.number == from.right;
        v.left_gain_mps = to_the_right ? way_back_mps : 0.0;
        v.right_gain_mps = to_the_right ? 0.0 : way_back_mps;
        v.accepted_gap_on = -1;
        routes_.adopt_lane_route(other.number, v);
        other.vehicles.insert(other.vehicles.begin() + static_cast<std::ptrdiff_t>(index), std::move(v));
        for (Lane* const changed : {&from, &other}) {
            changed->disturbed_tick = w_.tick;
            for (Vehicle& on_lane : changed->vehicles) on_lane.is_in_queue = false;
        }
        reset_leader(other, index);
        reset_leader(other, index + 1);
        reset_leader(from, old_index);
        // The vehicle may be ahead of the one that was chosen to stop at the line.
        other.stopping_id = -1;
    }

    // Gives a vehicle the one ahead of it as its new leader. The first vehicle finds its leader in the next step.
    static void reset_leader(Lane& on, std::size_t index) {
        if (index >= on.vehicles.size()) return;
        Vehicle& v = on.vehicles[index];
        v.lost_leader = index == 0 && v.leader_id >= 0;
        v.lost_leader = index == 0 && v.leader_id >= 0;
        v.leader_id = index == 0 ? -1 : on.vehicles[index - 1].id;
        if (index == 0) return;
        const Vehicle& ahead = on.vehicles[index - 1];
        v.is_platoon_leader = false;
        v.radar.assign(v.radar.size(), {ahead.rear_m() - v.position_m, v.speed_mps - ahead.speed_mps, v.speed_mps});
    }

    World& w_;
    const Routes& routes_;
    Perception perception_;
    LaneGaps gaps_;
    Requests requests_;
};

}  // namespace stopline::reference_engine
