#include "sim/lane_change.h"

#include <algorithm>
#include <cmath>

#include "base/arithmetic.h"
#include "sim/phases.h"

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

constexpr double kEvery_s = 0.5;    // each vehicle looks this often
constexpr double kBetween_s = 2.0;  // at least, from one change to the next: about what it takes
constexpr double kReturn_s =
    30.0;  // our choice: nobody goes back for speed sooner, as queues that move by turns would have it
constexpr double kReaction_s = 0.5;

// Acceleration by the intelligent driver model (Treiber, Hennecke, Helbing 2000), the policy's gap in place of s_0 + v T.
double idm_mps2(const Model& model, int policy, double speed_mps, double limit_mps, double gap_m, double ahead_mps) {
    const LaneChangeSettings& c = model.lane_change;
    constexpr double kAlone_m = 1e5;
    constexpr double kLeast_mps2 = -9.0;
    const double free = 1.0 - square(square(speed_mps / limit_mps));
    if (gap_m > kAlone_m) return c.acceleration_mps2 * free;
    const double closing =
        0.5 * speed_mps * (speed_mps - ahead_mps) / std::sqrt(c.acceleration_mps2 * c.deceleration_mps2);
    const double wanted_m = std::max(desired_gap_m(model, policy, speed_mps) + closing, 0.0);
    return std::max(c.acceleration_mps2 * (free - square(wanted_m / std::max(gap_m, 0.1))), kLeast_mps2);
}

double behind_mps2(const Model& model, const Neighbour& follower, double limit_mps, double gap_m, double ahead_mps) {
    return idm_mps2(model, follower.policy, follower.speed_mps, limit_mps, gap_m, ahead_mps);
}

// What MOBIL weighs, for a change of `me` to another lane.
double incentive_mps2(const Model& model, const State& state, const Changer& me, const Around& here,
                      const Around& there, bool to_the_right) {
    const LaneChangeSettings& c = model.lane_change;
    const double limit_mps = state.plan.driven_mps(me.lane);
    const auto own = [&](const Neighbour& ahead) {
        return idm_mps2(model, me.policy, me.speed_mps, limit_mps, ahead.gap_m, ahead.speed_mps);
    };
    double gain = own(there.ahead) - own(here.ahead) + (to_the_right ? c.keep_right_mps2 : -c.keep_right_mps2);
    if (c.politeness == 0.0) return gain;
    if (there.behind.slot >= 0) {
        const double open_m = there.behind.gap_m + me.length_m + there.ahead.gap_m;
        gain += c.politeness * (behind_mps2(model, there.behind, limit_mps, there.behind.gap_m, me.speed_mps) -
                                behind_mps2(model, there.behind, limit_mps, open_m, there.ahead.speed_mps));
    }
    if (here.behind.slot >= 0) {
        const double open_m = here.behind.gap_m + me.length_m + here.ahead.gap_m;
        gain += c.politeness * (behind_mps2(model, here.behind, limit_mps, open_m, here.ahead.speed_mps) -
                                behind_mps2(model, here.behind, limit_mps, here.behind.gap_m, me.speed_mps));
    }
    return gain;
}

bool gaps_are_enough(const Model& model, const Changer& me, const Around& there, double share) {
    constexpr double kLeast_m = 1.0;
    const auto enough = [&](const Neighbour& other, double needed_m) {
        return other.slot < 0 || other.gap_m >= std::max(needed_m, kLeast_m);
    };
    return enough(there.ahead, needed_gap_m(model, me.policy, me.speed_mps, there.ahead.speed_mps, share)) &&
           enough(there.behind, needed_gap_m(model, there.behind.policy, there.behind.speed_mps, me.speed_mps, share));
}

// Changes that are left to be made, for the turn after or on all of its trip, if a vehicle leaves the approach with `turn` from a lane;
// many: it can't.
int changes_after(const State& state, int lane, Turn turn, const VehicleRecord& vehicle) {
    constexpr int kMany = 100;
    const int route = state.plan.beside(lane).way(turn).route;
    if (route < 0) return kMany;
    if (vehicle.trip >= 0) return state.plan.changes_after(vehicle.trip, vehicle.leg, lane);
    const Turn after = vehicle.turn_after;
    return after == Turn::none ? 0 : std::abs(state.plan.beside(state.plan.route(route).back()).way(after).changes);
}

// Signed as WayOn::changes; all lanes up to there lead on.
int wished_changes(const State& state, int lane, Turn turn, const VehicleRecord& vehicle) {
    int fewest = changes_after(state, lane, turn, vehicle);
    int wished = 0;
    int distance = 0;
    for (int other = state.plan.beside(lane).right; other >= 0; other = state.plan.beside(other).right) {
        const int changes = changes_after(state, other, turn, vehicle);
        if (state.plan.beside(other).way(turn).route < 0) break;
        ++distance;
        if (changes >= fewest) continue;
        fewest = changes;
        wished = distance;
    }
    distance = 0;
    for (int other = state.plan.beside(lane).left; other >= 0; other = state.plan.beside(other).left) {
        const int changes = changes_after(state, other, turn, vehicle);
        if (state.plan.beside(other).way(turn).route < 0) break;
        --distance;
        if (changes > fewest || (changes == fewest && -distance >= wished)) continue;
        fewest = changes;
        wished = distance;
    }
    return wished;
}

// Its body is on the lane, and there is such a place on the other; the stop line can still be minded.
bool can_be_there(const Model& model, const Changer& me, double front_there_m) {
    return me.front_m >= me.length_m && front_there_m >= me.length_m &&
           me.to_line_m + model.driver.stop.margin_m >= comfortable_stop_m(model, me.speed_mps);
}

class Change {
public:
    Change(const Model& model, State& state, int lane, int slot)
        : model_(model), state_(state), me_(changer_at(model, state, lane, slot)), since_(since_change(slot)) {}

    // Whether the vehicle has left the lane.
    bool done() {
        const BesidePlan& beside = state_.plan.beside(me_.lane);
        if (me_.changes != 0 && me_.to_line_m < model_.lane_change.strategic_m * std::abs(me_.changes)) {
            return since_ >= kBetween_s && for_route(me_.changes < 0 ? beside.left : beside.right, me_.to_line_m);
        }
        if (me_.wished != 0 && me_.to_next_line_m < model_.lane_change.strategic_m * std::abs(me_.wished)) {
            return since_ >= kBetween_s && for_route(me_.wished < 0 ? beside.left : beside.right, me_.to_next_line_m);
        }
        if (since_ < model_.lane_change.pause_s) return false;
        return for_speed(beside.right, beside.left);
    }

private:
    double since_change(int slot) const {
        return model_.time_s(state_.tick - state_.vehicles.record[at(slot)].changed_at);
    }

    int route_on(int lane) const { return state_.plan.beside(lane).way(me_.turn).route; }

    Around look(int other) const {
        return around(model_, state_, other, beside_m(state_, me_.lane, me_.front_m, other), me_.length_m,
                      route_on(other));
    }

    bool for_route(int other, double to_line_m) {
        if (other < 0 || !can_be_there(model_, me_, beside_m(state_, me_.lane, me_.front_m, other))) return false;
        const Around there = look(other);
        if (!gaps_are_enough(model_, me_, there, urgent_share(model_, to_line_m))) return false;
        go(other, there, true);
        return true;
    }

    // Where the route goes on as well as from here.
    bool serves(int other) const {
        if (other < 0 || !can_be_there(model_, me_, beside_m(state_, me_.lane, me_.front_m, other))) return false;
        const VehicleRecord& vehicle = state_.vehicles.record[at(me_.slot)];
        if (other == vehicle.changed_from && since_ < kReturn_s) return false;
        if (changes_after(state_, other, me_.turn, vehicle) > changes_after(state_, me_.lane, me_.turn, vehicle))
            return false;
        const int changes = std::abs(state_.plan.beside(other).way(me_.turn).changes);
        return route_on(other) >= 0 || me_.to_line_m > model_.lane_change.strategic_m * changes;
    }

    bool for_speed(int right, int left) {
        const bool may_right = serves(right);
        const bool may_left = serves(left);
        if (!may_right && !may_left) return false;
        const LaneBlock& block = state_.blocks[at(me_.lane)];
        const VehicleArrays& v = state_.vehicles;
        Around here;
        if (me_.slot > block.first) {
            here.ahead = {
                me_.slot - 1,
                v.position_m[at(me_.slot - 1)] - static_cast<double>(v.length_m[at(me_.slot - 1)]) - me_.front_m,
                v.speed_mps[at(me_.slot - 1)], v.policy[at(me_.slot - 1)]};
        } else {
            here.ahead = beyond_own();
        }
        if (me_.slot < block.last()) {
            here.behind = {me_.slot + 1, me_.front_m - me_.length_m - v.position_m[at(me_.slot + 1)],
                           v.speed_mps[at(me_.slot + 1)], v.policy[at(me_.slot + 1)]};
        }
        double best_mps2 = model_.lane_change.threshold_mps2;
        int chosen = -1;
        Around chosen_around;
        for (const int other : {may_right ? right : -1, may_left ? left : -1}) {
            if (other < 0) continue;
            const Around there = look(other);
            const double gain = incentive_mps2(model_, state_, me_, here, there, other == right);
            if (gain <= best_mps2 || !gaps_are_enough(model_, me_, there, model_.lane_change.gap_share)) continue;
            best_mps2 = gain;
            chosen = other;
            chosen_around = there;
        }
        if (chosen < 0) return false;
        go(chosen, chosen_around, false);
        return true;
    }

    Neighbour beyond_own() const {
        const VehicleArrays& v = state_.vehicles;
        const Ahead seen = vehicle_ahead(state_, me_.lane, me_.slot, model_.driver.cacc.radar_range_m);
        if (seen.slot < 0) return {};
        const double rear_m = v.position_m[at(seen.slot)] - static_cast<double>(v.length_m[at(seen.slot)]);
        return {seen.slot, seen.start_m + rear_m - me_.front_m, v.speed_mps[at(seen.slot)], v.policy[at(seen.slot)]};
    }

    void go(int other, const Around& there, bool for_route) {
        VehicleArrays& v = state_.vehicles;
        const int id = v.id[at(me_.slot)];
        const int from = me_.slot - state_.blocks[at(me_.lane)].first;
        const int slot = put_beside(model_, state_, me_.lane, from, other, there.place,
                                    beside_m(state_, me_.lane, me_.front_m, other));
        VehicleRecord& record = v.record[at(slot)];
        record.changed_at = static_cast<int>(state_.tick);
        record.changed_from = me_.lane;
        record.cleared_for = -1;
        take_way_of_lane(model_, state_, other, slot);
        follow_anew(state_, slot, state_.blocks[at(other)]);
        follow_anew(state_, slot + 1, state_.blocks[at(other)]);
        follow_anew(state_, state_.blocks[at(me_.lane)].first + from, state_.blocks[at(me_.lane)]);
        // Who stops at the line there may be another one now.
        state_.stop_lines[at(other)].stopper = -1;
        state_.lane_changes.push_back(
            {model_.time_s(state_.tick + 1), id, me_.lane, other, static_cast<float>(me_.front_m), for_route});
    }

    const Model& model_;
    State& state_;
    Changer me_;
    double since_;
};

}  // namespace

Changer changer_at(const Model& model, const State& state, int lane, int slot) {
    const VehicleArrays& v = state.vehicles;
    Changer me;
    me.lane = lane;
    me.slot = slot;
    me.front_m = v.position_m[at(slot)];
    me.length_m = v.length_m[at(slot)];
    me.speed_mps = v.speed_mps[at(slot)];
    me.policy = v.policy[at(slot)];
    me.turn = state.plan.turn_of(v.record[at(slot)].route);
    me.changes = state.plan.beside(lane).way(me.turn).changes;
    me.to_line_m = state.plan.lane(lane).stop_line_m - model.driver.stop.margin_m - me.front_m;
    const Turn after = v.record[at(slot)].turn_after;
    if (me.changes != 0 || after == Turn::none) return me;
    me.wished = wished_changes(state, lane, me.turn, v.record[at(slot)]);
    const int exit = state.plan.route(v.record[at(slot)].route).back();
    me.to_next_line_m = me.to_line_m + state.plan.beside(exit).begin_m + state.plan.lane(exit).stop_line_m;
    return me;
}

double urgent_share(const Model& model, double to_line_m) {
    const LaneChangeSettings& c = model.lane_change;
    const double near = std::clamp(1.0 - to_line_m / c.urgent_m, 0.0, 1.0);
    return c.gap_share + near * (c.urgent_gap_share - c.gap_share);
}

double waiting_place_m(const Model& model, const State& state, const Changer& me) {
    const double apart_m = me.length_m + 2.0 * state.vehicles.standstill_gap_m[at(me.slot)];
    const int before = std::abs(me.changes) - (me.changes < 0 ? 1 : 0);
    const int other = me.changes < 0 ? state.plan.beside(me.lane).left : state.plan.beside(me.lane).right;
    // Not before the lane that it wants to has begun.
    const double least_m = beside_m(state, other, 0.0, me.lane) + me.length_m + 1.0;
    const double line_m = state.plan.lane(me.lane).stop_line_m - model.driver.stop.margin_m;
    return std::min(std::max(line_m - before * apart_m, least_m), line_m);
}

double comfortable_stop_m(const Model& model, double speed_mps) {
    return 0.5 * square(speed_mps) / model.driver.stop.deceleration_mps2 + kReaction_s * speed_mps;
}

void change_lanes(const Model& model, State& state) {
    const std::int64_t every = std::max<std::int64_t>(to_ticks(kEvery_s, model.step_s), 1);
    for (const int lane : state.plan.changing()) {
        const LaneBlock& block = state.blocks[at(lane)];
        for (int place = 0; place < block.count;) {
            const int slot = block.first + place;
            const VehicleRecord& record = state.vehicles.record[at(slot)];
            const bool looks = (state.tick + state.vehicles.id[at(slot)]) % every == 0 &&
                               record.changed_at != state.tick && record.route >= 0;
            if (!looks || !Change(model, state, lane, slot).done()) ++place;
        }
    }
}

}  // namespace stopline
