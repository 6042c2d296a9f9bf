// Speed adaptation for mandatory lane changes. Near the stop line a vehicle aligns its speed with a gap in the target
// lane. A vehicle that finds no gap stops before the line and waits for a gap.
#include "sim/lane_change/gap_search.h"

#include <algorithm>
#include <cmath>

#include "base/containers/index.h"
#include "base/random.h"
#include "driver/following_model.h"
#include "sim/lane_change/gap_cooperation.h"
#include "sim/lane_change/lane_change.h"
#include "sim/perception/lane_gaps.h"
#include "sim/state/lane_blocks.h"
#include "sim/state/queries/desired_gap.h"
#include "sim/state/queries/stopping_distance.h"

namespace stopline {

namespace {

constexpr double kFallBack_mps = 3.0;  // speed difference with which a vehicle falls back behind another vehicle
constexpr double kMinSpeed_mps = 1.0;  // lowest target speed of a vehicle that falls back
// Ratio of the target gap to the required gap. A vehicle approaches its target gap ever more slowly. The ratio is above
// 1, so that the vehicle reaches the required gap soon.
constexpr double kTargetGapFactor = 1.1;
// If the follower in the target lane is slower than the lane-changing vehicle by more than this speed, the lag gap
// grows by itself.
constexpr double kDroppingBack_mps = 0.5;
// Planned deceleration of a vehicle that opens a gap. It is lower than SpeedTarget::kDeceleration_mps2, the limit for
// the choice of this vehicle. The vehicle therefore brakes as soon as it is chosen, and keeps a reserve.
constexpr double kPlannedOpening_mps2 = 1.5;

class GapSearch {
public:
    GapSearch(const Model& model, State& state, Partition& part, int lane)
        : model_(model), state_(state), v_(state.vehicles), part_(part), lane_(lane) {}

    void search() {
        const LaneBlock& block = state_.blocks[at(lane_)];
        for (int slot = block.first; slot < block.past_last(); ++slot) {
            if (v_.next_lane[at(slot)] >= 0 && v_.lane_memory[at(slot)].preferred_offset == 0) continue;
            const LaneChangeRequest me = lane_change_request(model_, state_, lane_, slot);
            if (me.to_line_m < -model_.driver_of(me.policy).tables.stop.margin_m) continue;
            if (me.lane_changes != 0) add_stop(me);
            const MandatoryChange change = mandatory_change(model_, state_, me);
            if (change.lane_changes != 0 && !has_gap_agreement(state_, lane_, slot)) align_with_gap(me, change);
        }
    }

private:
    void add_stop(const LaneChangeRequest& me) {
        const double place_m = waiting_position_m(model_, state_, me);
        if (place_m - me.front_m > decision_distance_m(model_.driver_of(me.policy), me.speed_mps)) return;
        add_yield_stop(state_.junctions, part_, lane_, {me.slot, place_m, -1, YieldReason::lane_change});
    }

    // Returns the speed with which a vehicle gradually reaches its target gap behind `ahead`. The speed is at least the
    // speed of `ahead` minus kFallBack_mps. `braking_mps2`: planned deceleration.
    double gap_reaching_speed_mps(const Neighbour& ahead, int policy, double speed_mps, double braking_mps2) const {
        const DriverPlan& driver = model_.driver_of(policy);
        const double share = kTargetGapFactor * driver.lane_change.gap_share;
        const double spare_gap_m =
            ahead.gap_m - share * desired_gap_m(model_, policy, std::min(speed_mps, ahead.speed_mps));
        return std::max(braking_speed_mps(braking_mps2, kBrakingReaction_s, spare_gap_m, ahead.speed_mps),
                        ahead.speed_mps - kFallBack_mps);
    }

    // Returns true if the vehicle in `slot` of lane `other` must change to the lane of `me`, while `me` must change to
    // lane `other`. Of two vehicles that want to swap lanes, the vehicle further upstream falls back.
    bool wants_to_swap(int other, int slot, const LaneChangeRequest& me) const {
        if (!state_.blocks[at(other)].has(slot)) return false;
        return me.lane_changes * lane_change_request(model_, state_, other, slot).lane_changes < 0;
    }

    // Returns true if the lag gap to `follower` is too short and does not grow by itself. While `me` is almost at rest,
    // any lag gap counts as too short, so that the follower keeps the gap open until the leader on lane `other` has
    // moved away. Returns false if the follower wants to swap lanes with `me`, because the follower then falls back.
    bool must_let_pass(int other, const Neighbour& follower, const LaneChangeRequest& me, double urgency) const {
        if (follower.slot < 0 || follower.speed_mps + kDroppingBack_mps < me.speed_mps) return false;
        const double share = urgent_share(model_.driver_of(me.policy).lane_change, urgency);
        const double needed_m = required_gap_m(model_, follower.policy, follower.speed_mps, me.speed_mps, share);
        const bool waits = me.speed_mps < kMinSpeed_mps;  // `me` is almost at rest
        return (waits || follower.gap_m < needed_m) && !wants_to_swap(other, follower.slot, me);
    }

    // Returns true if the vehicle in `slot` opens a gap for `me` without a request.
    bool helps(int slot, const LaneChangeRequest& me) const {
        const DriverPlan& driver = model_.driver_of(v_.policy[at(slot)]);
        if (driver.gap_opening != GapOpening::cooperative) return driver.gap_opening == GapOpening::on;
        // Vehicles with V2V open gaps on request. Only a vehicle that waits almost at rest needs no request.
        if (!driver.is_human) return me.speed_mps < kMinSpeed_mps;
        return random_uniform(model_.seed, static_cast<std::uint64_t>(v_.id[at(slot)]),
                              static_cast<std::uint64_t>(v_.id[at(me.slot)]),
                              Purpose::courtesy) < driver.lane_change.courtesy;
    }

    // Returns the vehicle on lane `other` that opens a gap for `me`. It is the first vehicle behind `me` that can brake
    // to the speed of `me` with SpeedTarget::kDeceleration_mps2 and still has the gap that `me` requires at rest with
    // the highest urgency. If both vehicles are almost at rest, the gap cannot grow any more. So it must then suffice
    // for the present urgency of `me`, and the vehicle must not have let a vehicle in before (has_let_in()). The slot
    // is -1 if there is no such vehicle or if gap opening is off.
    Neighbour gap_opener(int other, const Neighbour& follower, const LaneChangeRequest& me, double urgency) const {
        // Number of vehicles checked. Vehicles further upstream are still too far away to open a gap for `me`.
        constexpr int kMaxSearched = 5;
        const LaneBlock& block = state_.blocks[at(other)];
        if (follower.slot < block.first) return {};
        const int end = std::min(block.past_last(), follower.slot + kMaxSearched);
        const bool waiting = has_reached_waiting_position(model_, state_, me);
        for (int slot = follower.slot; slot < end; ++slot) {
            const double gap_m = follower.gap_m + v_.position_m[at(follower.slot)] - v_.position_m[at(slot)];
            const double braking_m =
                braking_distance_m(v_.speed_mps[at(slot)], me.speed_mps, SpeedTarget::kDeceleration_mps2);
            const int policy = v_.policy[at(slot)];
            if (!helps(slot, me)) continue;
            const bool both_crawl = me.speed_mps < kMinSpeed_mps && v_.speed_mps[at(slot)] < kMinSpeed_mps;
            if (both_crawl && has_let_in(slot, waiting)) continue;
            const double share = urgent_share(model_.driver_of(me.policy).lane_change, both_crawl ? urgency : 1.0);
            const double needed_m = required_gap_m(model_, policy, 0.0, 0.0, share);
            if (gap_m >= braking_m + needed_m) return {slot, gap_m, v_.speed_mps[at(slot)], policy};
        }
        return {};
    }

    // Returns true if the queued vehicle in `slot` has already let in a vehicle on this approach. The vehicles of two
    // lanes therefore take turns. Otherwise a queue could wait without end for vehicles that change to its lane.
    // Vehicles at their waiting position and all others count separately. A vehicle at its waiting position may block
    // its lane, so a queued vehicle lets it in even if it has let in another one further upstream. `waiting`: the
    // vehicle to be let in has reached its waiting position.
    bool has_let_in(int slot, bool waiting) const {
        const LaneChangeMemory& memory = v_.lane_memory[at(slot)];
        const int latest_tick = waiting ? memory.let_in_waiting_tick : memory.let_in_tick;
        return latest_tick > v_.record[at(slot)].junction_entry_tick;
    }

    // Returns the target speed of a vehicle that opens a gap for `me`.
    double opening_speed_mps(const Neighbour& opener, const LaneChangeRequest& me) const {
        const Neighbour ahead{me.slot, opener.gap_m, me.speed_mps, me.policy};
        // If `me` waits almost at rest, the opener may stop completely. Otherwise the opener would creep past `me`.
        const double lowest_mps = me.speed_mps < kMinSpeed_mps ? 0.0 : kMinSpeed_mps;
        const double comfortable_mps2 = model_.driver_of(opener.policy).tables.stop.deceleration_mps2;
        const double braking_mps2 = std::min(kPlannedOpening_mps2, comfortable_mps2);
        return std::max(gap_reaching_speed_mps(ahead, opener.policy, opener.speed_mps, braking_mps2), lowest_mps);
    }

    // Aligns the speed of `me` with a gap in the adjacent lane. If the lag gap is too short, makes a vehicle in the
    // adjacent lane open a gap.
    void align_with_gap(const LaneChangeRequest& me, const MandatoryChange& change) {
        const AdjacentLanes& adjacent = state_.plan.adjacent(lane_);
        const int other = change.lane_changes < 0 ? adjacent.left : adjacent.right;
        if (other < 0) return;
        const double front_on_target_m = adjacent_position_m(state_, lane_, me.front_m, other);
        if (front_on_target_m < me.length_m) return;
        const LaneNeighbours there =
            neighbours_at(model_, state_, other, front_on_target_m, me.length_m, route_from(other, me));
        double target_mps = kUnlimitedSpeed_mps;
        // If the leader in the adjacent lane is slow, the vehicle does not align with it but drives on beside the
        // queue.
        if (there.leader.slot >= 0 && there.leader.speed_mps > kFallBack_mps) {
            const double braking_mps2 = model_.driver_of(me.policy).tables.stop.deceleration_mps2;
            target_mps = gap_reaching_speed_mps(there.leader, me.policy, me.speed_mps, braking_mps2);
        }
        const Neighbour& follower = there.follower;
        if (must_let_pass(other, follower, me, change.urgency())) {
            const Neighbour opener = gap_opener(other, follower, me, change.urgency());
            if (opener.slot >= 0) add_speed_target(state_, part_, other, {opener.slot, opening_speed_mps(opener, me)});
            // If the follower itself does not open the gap, it goes first, and `me` falls back behind it.
            if (opener.slot != follower.slot)
                target_mps = std::min(target_mps, std::max(follower.speed_mps - kFallBack_mps, kMinSpeed_mps));
        }
        // Our choice: a target further above the present speed does not restrain the vehicle within this step.
        constexpr double kNoRestraint_mps = 1.0;
        if (target_mps < me.speed_mps + kNoRestraint_mps) add_speed_target(state_, part_, lane_, {me.slot, target_mps});
    }

    int route_from(int other, const LaneChangeRequest& me) const {
        return state_.plan.adjacent(other).turn_option(me.turn).route;
    }

    const Model& model_;
    State& state_;
    const VehicleArrays& v_;
    Partition& part_;
    int lane_;
};

}  // namespace

void prepare_lane_changes(const Model& model, State& state, Partition& part) {
    if (state.plan.lanes_with_neighbours().empty()) return;
    if (state.gap_cooperation.is_on()) cooperate_on_gaps(model, state, part);
    for (const int lane : part.occupied) {
        if (state.plan.adjacent(lane).has_neighbours()) GapSearch(model, state, part, lane).search();
    }
}

}  // namespace stopline
