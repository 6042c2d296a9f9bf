#include "sim/lane_change/lane_change.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/containers/index.h"
#include "base/simd/arithmetic.h"
#include "base/speed_thresholds.h"
#include "sim/lane_change/gap_cooperation.h"
#include "sim/lane_change/preferred_lane.h"
#include "sim/lane_change/route_choice.h"
#include "sim/perception/lane_gaps.h"
#include "sim/perception/look_ahead.h"
#include "sim/perception/reset_leader.h"
#include "sim/state/lane_blocks.h"
#include "sim/state/no_leader.h"
#include "sim/state/queries/desired_gap.h"
#include "sim/state/queries/gap.h"
#include "sim/state/queries/stopping_distance.h"
#include "sim/state/state.h"

namespace stopline {

namespace {

constexpr double kDecisionInterval_s = 0.5;  // time between two lane-change decisions of a vehicle
constexpr double kMinInterval_s = 2.0;       // shortest time from a lane change to the vehicle's next mandatory change
// The gain of a lane is a speed: the sum over time of the incentives (accelerations, incentive_mps2()) to change to
// this lane. The gain fades with the time constant kGainMemory_s. A vehicle changes when the gain reaches
// LaneChangeSettings::gain_mps. To return to the lane that it has just left, the vehicle at first needs kReturnFactor
// times this gain. This need falls to the normal gain with the time constant kReturnMemory_s. The three values are our
// choice. They keep most vehicles from changing back and forth between adjacent queues that move in turn.
constexpr double kGainMemory_s = 10.0;
constexpr double kReturnFactor = 10.0;
constexpr double kReturnMemory_s = 30.0;
// A pocket is a lane that begins downstream of the start of the approach. This is the distance from the start of a
// pocket to the rear of a vehicle that waits beside the pocket to change lanes.
constexpr double kBesidePocket_m = 1.0;

// Returns the acceleration of the intelligent driver model (Treiber, Hennecke, Helbing 2000), with the desired gap of
// the policy in place of the model's own gap s_0 + v T (standstill gap plus speed times time gap).
double idm_mps2(const Model& model, int policy, double speed_mps, double limit_mps, double gap_m, double ahead_mps) {
    const LaneChangeSettings& c = model.driver_of(policy).lane_change;
    constexpr double kMinAcceleration_mps2 = -9.0;
    const double free = 1.0 - square(square(speed_mps / limit_mps));
    if (gap_m > kLongestGap_m) return c.acceleration_mps2 * free;
    const double closing_gap_m =
        0.5 * speed_mps * (speed_mps - ahead_mps) / std::sqrt(c.acceleration_mps2 * c.deceleration_mps2);
    const double wanted_m = std::max(desired_gap_m(model, policy, speed_mps) + closing_gap_m, 0.0);
    return std::max(c.acceleration_mps2 * (free - square(wanted_m / std::max(gap_m, 0.1))), kMinAcceleration_mps2);
}

double follower_mps2(const Model& model, const Neighbour& follower, double limit_mps, double gap_m, double ahead_mps) {
    return idm_mps2(model, follower.policy, follower.speed_mps, limit_mps, gap_m, ahead_mps);
}

// Returns the MOBIL incentive of vehicle `me` for a lane change, m/s2. `here`: the leader and the follower of `me` on
// its present lane. `there`: those on the target lane.
double incentive_mps2(const Model& model, const State& state, const LaneChangeRequest& me, const LaneNeighbours& here,
                      const LaneNeighbours& there, bool to_the_right) {
    const LaneChangeSettings& c = model.driver_of(me.policy).lane_change;
    const double limit_mps = state.plan.free_speed_mps(me.lane, me.policy);
    const auto own = [&](const Neighbour& ahead) {
        return idm_mps2(model, me.policy, me.speed_mps, limit_mps, ahead.gap_m, ahead.speed_mps);
    };
    double gain = own(there.leader) - own(here.leader) + (to_the_right ? c.keep_right_mps2 : -c.keep_right_mps2);
    if (c.politeness == 0.0) return gain;
    if (there.follower.slot >= 0) {
        const double joined_gap_m = there.follower.gap_m + me.length_m + there.leader.gap_m;
        gain += c.politeness * (follower_mps2(model, there.follower, limit_mps, there.follower.gap_m, me.speed_mps) -
                                follower_mps2(model, there.follower, limit_mps, joined_gap_m, there.leader.speed_mps));
    }
    if (here.follower.slot >= 0) {
        const double joined_gap_m = here.follower.gap_m + me.length_m + here.leader.gap_m;
        gain += c.politeness * (follower_mps2(model, here.follower, limit_mps, joined_gap_m, here.leader.speed_mps) -
                                follower_mps2(model, here.follower, limit_mps, here.follower.gap_m, me.speed_mps));
    }
    return gain;
}

bool gaps_suffice(const Model& model, const LaneChangeRequest& me, const LaneNeighbours& there, double share) {
    const auto suffices = [&](const Neighbour& other, double needed_m) {
        return other.slot < 0 || other.gap_m >= needed_m;
    };
    return suffices(there.leader, required_gap_m(model, me.policy, me.speed_mps, there.leader.speed_mps, share)) &&
           suffices(there.follower,
                    required_gap_m(model, there.follower.policy, there.follower.speed_mps, me.speed_mps, share));
}

// Returns true if the whole vehicle is on its lane and fits on the target lane, and if it can still stop before the
// stop line.
bool can_move_beside(const Model& model, const LaneChangeRequest& me, double front_there_m) {
    return me.front_m >= me.length_m && front_there_m >= me.length_m &&
           me.to_line_m + model.driver_of(me.policy).tables.stop.margin_m >=
               lane_change_stopping_distance_m(model.driver_of(me.policy), me.speed_mps);
}

// Returns the usable distance (MandatoryChange::usable_m) below which a vehicle looks for a gap, m. `changes`: number
// of lane changes that the vehicle needs; below 0: to the left.
double look_ahead_m(const Model& model, const LaneChangeRequest& me, double remembered_mps, int changes) {
    const LaneChangeSettings& c = model.driver_of(me.policy).lane_change;
    const double time_s = c.look_ahead_s * std::abs(changes) * (changes < 0 ? c.left_factor : 1.0);
    const double room_m = 2.0 * (me.length_m + model.policies[at(me.policy)].settings.standstill_gap_m);
    return remembered_mps * time_s + room_m;
}

// Returns the lane that a vehicle on `lane` reaches with `changes` lane changes (below 0: to the left). Returns -1 if
// there is no such lane.
int lane_after_changes(const State& state, int lane, int changes) {
    for (int k = 0; k < std::abs(changes) && lane >= 0; ++k) {
        lane = changes < 0 ? state.plan.adjacent(lane).left : state.plan.adjacent(lane).right;
    }
    return lane;
}

// Returns the position of the vehicle's front from which on the whole vehicle is beside its target lane, if this lane
// is a pocket; else kNoPocket_m. The position includes the reserve kBesidePocket_m.
double pocket_entry_m(const State& state, const LaneChangeRequest& me) {
    const int target = lane_after_changes(state, me.lane, me.lane_changes);
    if (target < 0) return kNoPocket_m;
    const double start_m = adjacent_position_m(state, target, 0.0, me.lane);
    return start_m > 0.0 ? start_m + me.length_m + kBesidePocket_m : kNoPocket_m;
}

// Returns the length that the vehicles ahead of `me` on its target lane would have as a standing queue, m. Counts only
// vehicles before the next intersection, also for a later turn, because the driver does not see the others yet.
double queue_ahead_m(const State& state, const LaneChangeRequest& me, int changes) {
    const int lane = lane_after_changes(state, me.lane, changes);
    if (lane < 0) return 0.0;
    return vehicles_ahead(state, lane, adjacent_position_m(state, me.lane, me.front_m, lane)) *
           state.plan.max_space_per_vehicle_m();
}

// Returns the position one standstill gap behind the last vehicle of pocket `other`, m from the start of the lane of
// `me`, but at least the present position of `me`. The last vehicle is assumed to stop comfortably. Returns infinity if
// the pocket is empty, or if the front of `me` is already beside the last vehicle or further downstream.
double behind_pocket_queue_m(const Model& model, const State& state, const LaneChangeRequest& me, int other) {
    constexpr double kNoQueue_m = std::numeric_limits<double>::infinity();
    const LaneBlock& block = state.blocks[at(other)];
    if (block.count == 0) return kNoQueue_m;
    const VehicleArrays& v = state.vehicles;
    const int last = block.last();
    const double front_at_rest_m =
        v.position_m[at(last)] +
        comfortable_braking_distance_m(model.driver_of(v.policy[at(last)]), v.speed_mps[at(last)]);
    const double rear_m = adjacent_position_m(state, other, front_at_rest_m, me.lane) - v.length_m[at(last)];
    return me.front_m < rear_m ? std::max(rear_m - v.standstill_gap_m[at(me.slot)], me.front_m) : kNoQueue_m;
}

class LaneChangeDecision {
public:
    LaneChangeDecision(const Model& model, State& state, int lane, int slot)
        : model_(model),
          state_(state),
          me_(lane_change_request(model, state, lane, slot)),
          since_change_s_(time_since_change_s(slot)) {}

    // Changes lanes if the vehicle wants to change and the gaps suffice. Returns true if the vehicle has left its lane.
    bool execute() {
        const AdjacentLanes& adjacent = state_.plan.adjacent(me_.lane);
        remember_speed();
        const MandatoryChange change = mandatory_change(model_, state_, me_);
        if (change.lane_changes != 0) {
            return since_change_s_ >= kMinInterval_s &&
                   change_for_route(change.lane_changes < 0 ? adjacent.left : adjacent.right, change.urgency());
        }
        if (since_change_s_ < lane_change().pause_s) return false;
        return change_for_speed(adjacent.right, adjacent.left);
    }

private:
    double time_since_change_s(int slot) const {
        return model_.time_s(state_.tick - state_.vehicles.lane_memory[at(slot)].change_tick);
    }

    const LaneChangeSettings& lane_change() const { return model_.driver_of(me_.policy).lane_change; }

    double remembered_mps() const { return state_.vehicles.lane_memory[at(me_.slot)].remembered_mps; }

    int route_on(int lane) const { return state_.plan.adjacent(lane).turn_option(me_.turn).route; }

    LaneNeighbours neighbours_on(int other) const {
        return neighbours_at(model_, state_, other, adjacent_position_m(state_, me_.lane, me_.front_m, other),
                             me_.length_m, route_on(other));
    }

    // Updates the remembered speed: the highest recent speed, which falls gradually while the vehicle is slower. The
    // lower the remembered speed, the nearer to the stop line a vehicle begins to look for a gap. A vehicle in a queue
    // thus begins later than a fast vehicle.
    void remember_speed() {
        constexpr double kMemory_s = 10.0;
        float& remembered_mps = state_.vehicles.lane_memory[at(me_.slot)].remembered_mps;
        const double faded_mps = remembered_mps + (me_.speed_mps - remembered_mps) * (kDecisionInterval_s / kMemory_s);
        remembered_mps = static_cast<float>(std::max(me_.speed_mps, faded_mps));
    }

    bool change_for_route(int other, double urgency) {
        if (other < 0 || !can_move_beside(model_, me_, adjacent_position_m(state_, me_.lane, me_.front_m, other)))
            return false;
        const LaneNeighbours there = neighbours_on(other);
        if (!gaps_suffice(model_, me_, there, urgent_share(lane_change(), urgency))) return false;
        change_to(other, there, true);
        return true;
    }

    // Returns true if the vehicle may change to lane `other` to gain speed. This lane must serve the route at least as
    // well as the current lane. If neither lane allows the next turn, enough distance for the required lane changes
    // must remain.
    bool may_change_for_speed(int other) const {
        if (other < 0 || !can_move_beside(model_, me_, adjacent_position_m(state_, me_.lane, me_.front_m, other)))
            return false;
        if (later_changes(model_, state_, other, me_.slot).in_total >
            later_changes(model_, state_, me_.lane, me_.slot).in_total)
            return false;
        return route_on(other) >= 0 || has_room_to_return(other);
    }

    // Returns true if the vehicle has enough usable distance for the lane changes that it would need from lane `other`.
    // The usable distance excludes the longer of the queues on the two lanes, because a vehicle finds no gap in a
    // queue.
    bool has_room_to_return(int other) const {
        const double end_m = std::min(me_.front_m + me_.to_line_m, me_.pocket_entry_m);
        const auto vehicles_before_end = [&](int lane) {
            return vehicles_ahead(state_, lane, adjacent_position_m(state_, me_.lane, me_.front_m, lane)) -
                   vehicles_ahead(state_, lane, adjacent_position_m(state_, me_.lane, end_m, lane));
        };
        const int vehicles = std::max(vehicles_before_end(me_.lane), vehicles_before_end(other));
        const double usable_m = end_m - me_.front_m - vehicles * state_.plan.max_space_per_vehicle_m();
        const int changes = state_.plan.adjacent(other).turn_option(me_.turn).lane_changes;
        return usable_m > look_ahead_m(model_, me_, remembered_mps(), changes);
    }

    // Lets the gain of a lane fade, and adds the part of this decision's incentive above the threshold. This part is
    // limited to the maximum acceleration of the intelligent driver model, because no vehicle gains speed faster. An
    // incentive below the threshold reduces the gain, but not below 0. Only the lane that the vehicle has just left can
    // have a negative gain.
    void add_gain(double incentive_mps2, float& gain_mps) const {
        const LaneChangeSettings& c = lane_change();
        const double memory_s = gain_mps < 0.0F ? kReturnMemory_s : kGainMemory_s;
        const double faded_mps = gain_mps * (1.0 - kDecisionInterval_s / memory_s);
        const double counted_mps2 = std::min(incentive_mps2 - c.threshold_mps2, c.acceleration_mps2);
        const double sum_mps = faded_mps + counted_mps2 * kDecisionInterval_s;
        gain_mps = static_cast<float>(std::max(sum_mps, std::min(faded_mps, 0.0)));
    }

    bool change_for_speed(int right, int left) {
        const bool may_right = may_change_for_speed(right);
        const bool may_left = may_change_for_speed(left);
        if (!may_right && !may_left) return false;
        const LaneBlock& block = state_.blocks[at(me_.lane)];
        const VehicleArrays& v = state_.vehicles;
        LaneNeighbours here;
        if (me_.slot > block.first) {
            here.leader = {me_.slot - 1, rear_m(v, me_.slot - 1) - me_.front_m, v.speed_mps[at(me_.slot - 1)],
                           v.policy[at(me_.slot - 1)]};
        } else {
            const double range_m = model_.common_driver().cacc.radar_range_m;
            here.leader = neighbour_beyond_lane(v, leader_ahead(state_, me_.lane, me_.slot, range_m), me_.front_m);
        }
        if (me_.slot < block.last()) {
            here.follower = {me_.slot + 1, me_.front_m - me_.length_m - v.position_m[at(me_.slot + 1)],
                             v.speed_mps[at(me_.slot + 1)], v.policy[at(me_.slot + 1)]};
        }
        LaneChangeMemory& memory = state_.vehicles.lane_memory[at(me_.slot)];
        double best_mps = lane_change().gain_mps;
        int chosen = -1;
        LaneNeighbours chosen_neighbours;
        const auto rate = [&](int other, bool may_change, bool to_the_right, float& gain_mps) {
            if (!may_change) return;
            const LaneNeighbours there = neighbours_on(other);
            add_gain(incentive_mps2(model_, state_, me_, here, there, to_the_right), gain_mps);
            if (static_cast<double>(gain_mps) < best_mps) return;
            if (!gaps_suffice(model_, me_, there, lane_change().gap_share)) return;
            if (there.follower.slot >= 0 &&
                is_reserved(state_, other, there.follower.slot, state_.vehicles.id[at(me_.slot)]))
                return;
            best_mps = gain_mps;
            chosen = other;
            chosen_neighbours = there;
        };
        rate(right, may_right, true, memory.right_gain_mps);
        rate(left, may_left, false, memory.left_gain_mps);
        if (chosen < 0) return false;
        change_to(chosen, chosen_neighbours, false);
        return true;
    }

    void change_to(int other, const LaneNeighbours& there, bool for_route) {
        VehicleArrays& v = state_.vehicles;
        const int id = v.id[at(me_.slot)];
        const int from = me_.slot - state_.blocks[at(me_.lane)].first;
        const bool had_waited = for_route && has_reached_waiting_position(model_, state_, me_);
        const int slot = move_to_lane(model_, state_, me_.lane, from, other, there.index,
                                      adjacent_position_m(state_, me_.lane, me_.front_m, other));
        v.lane_memory[at(slot)].change_tick = static_cast<int>(state_.tick);
        const bool has_follower = slot < state_.blocks[at(other)].last();
        if (for_route && has_follower && v.speed_mps[at(slot + 1)] < kCrawlingSpeed_mps) {
            LaneChangeMemory& follower = v.lane_memory[at(slot + 1)];
            (had_waited ? follower.let_in_waiting_tick : follower.let_in_tick) = static_cast<int>(state_.tick);
        }
        const auto way_back_mps = static_cast<float>((1.0 - kReturnFactor) * lane_change().gain_mps);
        const bool to_the_right = other == state_.plan.adjacent(me_.lane).right;
        v.lane_memory[at(slot)].left_gain_mps = to_the_right ? way_back_mps : 0.0F;
        v.lane_memory[at(slot)].right_gain_mps = to_the_right ? 0.0F : way_back_mps;
        v.record[at(slot)].accepted_gap_on = -1;
        adopt_lane_route(model_, state_, other, slot);
        reset_leader(state_.vehicles, slot, state_.blocks[at(other)]);
        reset_leader(state_.vehicles, slot + 1, state_.blocks[at(other)]);
        reset_leader(state_.vehicles, state_.blocks[at(me_.lane)].first + from, state_.blocks[at(me_.lane)]);
        // The vehicle that has changed lanes may be ahead of the vehicle chosen to stop at the line.
        // decide_stop_lines() therefore chooses again.
        state_.stop_lines.lines[at(other)].stopping_vehicle = -1;
        state_.records.lane_changes.push_back(
            {model_.time_s(state_.tick + 1), id, me_.lane, other, static_cast<float>(me_.front_m), for_route});
    }

    const Model& model_;
    State& state_;
    LaneChangeRequest me_;
    double since_change_s_;
};

}  // namespace

LaneChangeRequest lane_change_request(const Model& model, const State& state, int lane, int slot) {
    const VehicleArrays& v = state.vehicles;
    LaneChangeRequest me;
    me.lane = lane;
    me.slot = slot;
    me.front_m = v.position_m[at(slot)];
    me.length_m = v.length_m[at(slot)];
    me.speed_mps = v.speed_mps[at(slot)];
    me.policy = v.policy[at(slot)];
    me.turn = state.plan.turn_of(v.record[at(slot)].route);
    const DriverPlan& driver = model.driver_of(me.policy);
    const double line_m = state.plan.lane(lane).stop_line_m - driver.tables.stop.margin_m;
    me.to_line_m = line_m - me.front_m;
    // On a lane that is shorter than the vehicle, no lane change is possible (can_move_beside()).
    if (line_m >= me.length_m) me.lane_changes = state.plan.adjacent(lane).turn_option(me.turn).lane_changes;
    if (me.lane_changes != 0) me.pocket_entry_m = pocket_entry_m(state, me);
    const VehicleRecord& record = v.record[at(slot)];
    const LaneChangeMemory& memory = v.lane_memory[at(slot)];
    if (me.lane_changes != 0 || memory.preferred_offset == 0) return me;
    me.preferred_offset = memory.preferred_offset;
    const int exit = state.plan.route(record.route).back();
    const auto length_to_line_m = [&](int next) {
        return state.plan.adjacent(next).start_offset_m + state.plan.lane(next).stop_line_m;
    };
    me.to_preferred_line_m = me.to_line_m + length_to_line_m(exit);
    if (memory.preferred_for_third) {
        const int route = state.plan.route_with(model.graph.lanes[at(exit)].approach, record.following_turn);
        me.to_preferred_line_m += length_to_line_m(state.plan.route(route).back());
    }
    return me;
}

MandatoryChange mandatory_change(const Model& model, const State& state, const LaneChangeRequest& me) {
    MandatoryChange change;
    change.lane_changes = me.lane_changes != 0 ? me.lane_changes : me.preferred_offset;
    if (change.lane_changes == 0) return change;
    change.look_ahead_m =
        look_ahead_m(model, me, state.vehicles.lane_memory[at(me.slot)].remembered_mps, change.lane_changes);
    const double distance_m = me.lane_changes != 0 ? me.to_line_m : me.to_preferred_line_m;
    change.usable_m =
        std::min(distance_m - queue_ahead_m(state, me, change.lane_changes), me.pocket_entry_m - me.front_m);
    if (change.usable_m >= change.look_ahead_m) change.lane_changes = 0;
    return change;
}

double urgent_share(const LaneChangeSettings& settings, double urgency) {
    return settings.gap_share + urgency * (settings.urgent_gap_share - settings.gap_share);
}

double waiting_position_m(const Model& model, const State& state, const LaneChangeRequest& me) {
    const double spacing_m = me.length_m + 2.0 * state.vehicles.standstill_gap_m[at(me.slot)];
    const int places_behind_line = me.lane_changes < 0 ? 0 : 1;
    const int other = me.lane_changes < 0 ? state.plan.adjacent(me.lane).left : state.plan.adjacent(me.lane).right;
    // The waiting position must be beside the target lane. The target lane may start further downstream than this lane.
    const double min_position_m = adjacent_position_m(state, other, 0.0, me.lane) + me.length_m + kBesidePocket_m;
    const DriverPlan& driver = model.driver_of(me.policy);
    const double line_m = state.plan.lane(me.lane).stop_line_m - driver.tables.stop.margin_m;
    const double beside_m = std::min(std::max(line_m - places_behind_line * spacing_m, min_position_m), line_m);
    if (me.pocket_entry_m == kNoPocket_m) return beside_m;
    if (std::abs(me.lane_changes) == 1) return std::min(beside_m, behind_pocket_queue_m(model, state, me, other));
    return me.front_m <= me.pocket_entry_m ? std::min(beside_m, me.pocket_entry_m) : beside_m;
}

bool has_reached_waiting_position(const Model& model, const State& state, const LaneChangeRequest& me) {
    constexpr double kReached_m = 2.0;
    return me.lane_changes != 0 && me.speed_mps < kCrawlingSpeed_mps &&
           waiting_position_m(model, state, me) - me.front_m < kReached_m;
}

void change_lanes(const Model& model, State& state) {
    const std::int64_t interval_ticks = std::max<std::int64_t>(to_ticks(kDecisionInterval_s, model.step_s), 1);
    for (const int lane : state.plan.lanes_with_neighbours()) {
        const LaneBlock& block = state.blocks[at(lane)];
        for (int place = 0; place < block.count;) {
            const int slot = block.first + place;
            const VehicleRecord& record = state.vehicles.record[at(slot)];
            const bool decides_now = (state.tick + state.vehicles.id[at(slot)]) % interval_ticks == 0 &&
                                     state.vehicles.lane_memory[at(slot)].change_tick != state.tick &&
                                     record.route >= 0;
            if (!decides_now || !LaneChangeDecision(model, state, lane, slot).execute()) ++place;
        }
    }
}

}  // namespace stopline
