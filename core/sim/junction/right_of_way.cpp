// Right of way inside intersections: decides which vehicles must wait, and before which conflict area. All decisions
// use the positions and speeds at the beginning of the step. All vehicles keep out of occupied conflict areas. On each
// connection only the vehicles up to the first waiting vehicle check gaps. The vehicles behind that waiting vehicle
// check no gaps: before a conflict area where they must yield, they wait for the waiting vehicle.
//
// In a conflict area the connection of a vehicle meets another connection. The vehicle may enter the area under these
// conditions:
//   - No vehicle of the other connection is in the area. No vehicle of the other connection that has accepted a gap is
//     on its way to the area.
//   - If the vehicle must yield, the time between two vehicles with priority must be at least its critical gap
//     (needed_time_s() in gap_acceptance.cpp). The gap must suffice in all areas where the vehicle must yield. The gap
//     is checked again while the vehicle can still stop comfortably, because a stopped vehicle with priority may start.
//   - If neither connection has priority (movements of different signal groups), the vehicle that was the first to pass
//     its stop line drives first. Exception: if only one of the two vehicles can stop before the area, the other one
//     drives first. In a cycle of vehicles that wait for each other, one proceeds (DeadlockResolution).
//   - The vehicle does not close a cycle of vehicles that block each other (deadlock_avoidance.h).
// The pass-blocker rule (driver/traffic_rules.h) lets a vehicle pass another vehicle that has been stopped inside the
// intersection for a long time.
#include "sim/junction/right_of_way.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "base/containers/index.h"
#include "base/simd/arithmetic.h"
#include "base/speed_thresholds.h"
#include "sim/junction/arrivals.h"
#include "sim/junction/candidate.h"
#include "sim/junction/count_conflicts.h"
#include "sim/junction/deadlock_avoidance.h"
#include "sim/junction/deadlocks.h"
#include "sim/junction/gap_acceptance.h"
#include "sim/junction/merging.h"
#include "sim/junction/short_approaches.h"
#include "sim/junction/stop_signs.h"
#include "sim/state/queries/stopping_distance.h"

namespace stopline {

namespace {

// Returns true if the pass-blocker rule lets `vehicle` on connection `lane` pass `blocker` on connection `other`. The
// blocker must have been stopped for a long time, and the connections must lead to different exit lanes. The permission
// is stored in Partition::blocker_passes. It stays valid when the blocker starts, because the passing vehicle may then
// be unable to stop.
bool may_pass(const Model& model, State& state, Partition& part, int vehicle, int lane, int blocker, int other) {
    const VehicleArrays& v = state.vehicles;
    if (model.rules.pass_blocker_ticks == 0) return false;
    for (BlockerPass& known : part.blocker_passes) {
        if (known.vehicle != v.id[at(vehicle)] || known.blocker != v.id[at(blocker)]) continue;
        known.last_needed_tick = state.tick;
        return true;
    }
    const std::int64_t stopped_ticks = state.tick - v.stopped_since_tick[at(blocker)];
    if (stopped_ticks < model.rules.pass_blocker_ticks) return false;
    if (state.plan.lane(lane).exit == state.plan.lane(other).exit) return false;
    part.blocker_passes.push_back({v.id[at(vehicle)], v.id[at(blocker)], state.tick, stopped_ticks, false});
    return true;
}

// Returns true if an occupant of connection `conflict.other` keeps `candidate` out of the conflict area. The gap to
// approaching vehicles with priority is checked elsewhere (find_gap_blocker()).
bool blocks_area(const Model& model, State& state, Partition& part, int lane, const Conflict& conflict,
                 const Candidate& candidate, const JunctionOccupant& occupant) {
    if (occupant.rear_m >= conflict.other_to_m) return false;
    if (may_pass(model, state, part, candidate.slot, lane, occupant.slot, conflict.other)) return false;
    if (occupant.front_m > conflict.other_from_m) return true;
    if (occupant.slot == state.stop_lines.stop_slot[at(state.plan.lane(conflict.other).origin)]) return false;
    if (conflict.yields) return false;
    if (conflict.other_yields) {
        return state.vehicles.record[at(occupant.slot)].accepted_gap_on == conflict.other &&
               !is_yielding_before(state, occupant.slot, conflict.other_from_m);
    }
    // Neither connection has priority. If only one of the two vehicles can stop before the area, this vehicle waits.
    // The other vehicle would come to rest inside the area if it braked.
    const auto& speed_mps = state.vehicles.speed_mps;
    const bool can_stop = can_stop_within(model, speed_mps[at(candidate.slot)], conflict.from_m - candidate.front_m);
    const bool other_can_stop =
        can_stop_within(model, speed_mps[at(occupant.slot)], conflict.other_from_m - occupant.front_m);
    if (can_stop != other_can_stop) return can_stop;
    // If both vehicles wait for each other, a deadlock resolution decides which one proceeds.
    if (find_resolution(state, part, occupant.slot, candidate.slot) != nullptr) return true;
    if (DeadlockResolution* const resolution = find_resolution(state, part, candidate.slot, occupant.slot)) {
        resolution->last_needed_tick = state.tick;  // keeps the resolution from expiring
        return false;
    }
    // If the candidate is stopped, and the occupant yields or is in a queue behind a yielding vehicle, a new resolution
    // lets the candidate proceed.
    if (candidate.stopped &&
        (is_yielding(state, occupant.slot) || is_behind_yielding_vehicle(state, conflict.other, occupant))) {
        part.deadlock_resolutions.push_back(
            {state.vehicles.id[at(candidate.slot)], state.vehicles.id[at(occupant.slot)], state.tick});
        return false;
    }
    const std::int64_t entry_tick = state.vehicles.record[at(candidate.slot)].junction_entry_tick;
    const bool entered_earlier =
        occupant.since_tick < entry_tick || (occupant.since_tick == entry_tick && occupant.slot < candidate.slot);
    return !candidate.inside || entered_earlier;
}

// Finds where one candidate must wait, and for which vehicle.
class WaitSearch {
public:
    WaitSearch(const Model& model, State& state, Partition& part, int lane, const Candidate& candidate)
        : model_(model),
          state_(state),
          part_(part),
          lane_(lane),
          candidate_(candidate),
          v_(state.vehicles),
          record_(state.vehicles.record[at(candidate.slot)]),
          driver_(model.driver_of(state.vehicles.policy[at(candidate.slot)])),
          speed_mps_(state.vehicles.speed_mps[at(candidate.slot)]),
          is_imported_(model.is_imported()) {}

    // Returns where and for which vehicle the candidate must wait. `ahead`: slot of the nearest waiting vehicle ahead
    // of the candidate that takes the same connection; -1: none. Before a conflict area where the candidate must yield,
    // it waits for the vehicle `ahead` without checking gaps.
    Wait find(int ahead) {
        Wait wait = search(ahead);
        if (is_imported_ && wait.exists()) wait.place_m = clear_place_m(wait.place_m);
        return wait;
    }

private:
    Wait search(int ahead) {
        // A vehicle behind a stopped leader cannot use its accepted gap. Drop the gap, so that other vehicles do not
        // wait for this vehicle.
        if (candidate_.stopped && is_blocked_by_leader(state_, candidate_.slot)) record_.accepted_gap_on = -1;
        has_decided_ = record_.accepted_gap_on == lane_;
        const LanePlan& plan = state_.plan.lane(lane_);
        const double to_first_m = plan.first_conflict_m - driver_.give_way.margin_m - candidate_.front_m;
        if (!candidate_.stopped && to_first_m > comfortable_braking_distance_m(driver_, speed_mps_))
            has_decided_ = false;
        const bool has_others_inside = state_.junctions.occupied.has_any(state_.plan.conflicting(lane_));
        const LanePlan& origin = state_.plan.lane(plan.origin);
        const double line_m = origin.stop_line_m - origin.length_m - driver_.tables.stop.margin_m;
        line_m_ = stops_at_line(line_m) ? line_m : kNoWait_m;
        decision_m_ = decision_distance_m(driver_, speed_mps_);
        if (waits_at_line() && line_m_ - candidate_.front_m > decision_m_) return {};
        if (is_imported_) {
            if (const Wait wait = stop_sign_wait(model_, state_, lane_, candidate_, line_m); wait.exists()) return wait;
        }
        was_waiting_ = candidate_.stopped || had_to_wait(state_, candidate_.slot);
        const bool checks_committed = was_waiting_ || is_imported_;
        if (!has_others_inside && !checks_committed && (has_decided_ || !plan.yields)) return {};
        // A stopped candidate cannot use its accepted gap if it must not enter an area further ahead.
        const KeptOutArea kept_out = area_to_keep_clear(model_, state_, lane_, candidate_);
        if (kept_out.exists() && candidate_.stopped) has_decided_ = false;
        // The candidate may follow a vehicle that is about to leave a conflict area or that merges ahead of it, but
        // must stay able to stop behind that vehicle. `behind` is the nearest stopping place behind such a vehicle.
        Wait behind;
        for (const Conflict& conflict : state_.plan.conflicts(lane_)) {
            const bool merges = is_imported_ && is_merge(model_, state_, lane_, conflict);
            if (candidate_.front_m > (merges ? conflict.to_m : conflict.from_m)) continue;
            const bool is_far = wait_m(conflict) - candidate_.front_m > decision_m_;
            const bool is_beyond_decision = is_far && !waits_at_line();
            if (is_beyond_decision && !is_imported_) break;
            if (conflict.from_m >= kept_out.from_m && !is_beyond_decision)
                return nearer({std::min(wait_m(conflict), line_m_), kept_out.crossing_slot, YieldReason::deadlock},
                              behind);
            const bool is_empty = !has_others_inside || occupants_of(state_, conflict.other).empty();
            if (merges) {
                if (!is_beyond_decision) keep_nearer(merging_wait(conflict, is_empty), behind);
            } else if (const Wait wait = blocked_wait(conflict, is_empty, checks_committed, is_far); wait.exists()) {
                if (!clears_area_in_time(conflict, wait.blocker)) return nearer(wait, behind);
                keep_nearer({wait_m(conflict), wait.blocker, YieldReason::merging}, behind);
            }
            if (conflict.yields && !has_decided_ && !is_beyond_decision && candidate_.front_m <= conflict.from_m) {
                const GapBlocker blocker = kept_out.exists() ? GapBlocker{kept_out.crossing_slot, YieldReason::deadlock}
                                           : ahead >= 0      ? GapBlocker{ahead}
                                                             : gap_blocker(conflict);
                if (blocker.slot >= 0)
                    return nearer({std::min(wait_m(conflict), line_m_), blocker.slot, blocker.reason}, behind);
                has_decided_ = true;
            }
        }
        return behind;
    }

    bool waits_at_line() const { return line_m_ < kNoWait_m; }
    double wait_m(const Conflict& conflict) const { return conflict.from_m - driver_.give_way.margin_m; }

    static const Wait& nearer(const Wait& a, const Wait& b) { return b.place_m < a.place_m ? b : a; }
    static void keep_nearer(const Wait& wait, Wait& nearest) { nearest = nearer(nearest, wait); }

    // Returns true if the stop line is the only place where the candidate may wait. This requires that the candidate
    // can still stop at the line, and that vehicles on its connection may not wait inside the intersection. `line_m`:
    // waiting position at the line.
    bool stops_at_line(double line_m) const {
        if (candidate_.inside || state_.plan.may_wait_inside(lane_)) return false;
        if (candidate_.stopped || line_m - candidate_.front_m >= comfortable_braking_distance_m(driver_, speed_mps_))
            return true;
        // A vehicle that already brakes for the line can deviate slightly from the curve of a comfortable stop. It goes
        // on braking for the line as long as maximum braking suffices.
        const bool brakes_for_line =
            had_to_wait(state_, candidate_.slot) && record_.yield_position_m <= static_cast<float>(line_m);
        const double to_line_m = line_m + driver_.tables.stop.margin_m - candidate_.front_m;
        return brakes_for_line && to_line_m >= emergency_braking_distance_m(model_, speed_mps_);
    }

    // Returns the slot of a vehicle on connection `conflict.other` that keeps the candidate out of the conflict area;
    // -1: none.
    int area_blocker(const Conflict& conflict) {
        for (const JunctionOccupant& occupant : occupants_of(state_, conflict.other)) {
            if (blocks_area(model_, state_, part_, lane_, conflict, candidate_, occupant)) return occupant.slot;
        }
        return -1;
    }

    // Returns the slot of a vehicle without priority that can no longer stop (committed_vehicle()) and for which the
    // candidate must therefore wait; -1: none, or the candidate can no longer stop either. A candidate that has not
    // waited so far waits only if that vehicle will still be in the conflict area when the candidate arrives.
    int committed_blocker(const Conflict& conflict) const {
        const double braking_m = emergency_braking_distance_m(model_, speed_mps_);
        if (!conflict.other_yields || conflict.from_m - candidate_.front_m < braking_m) return -1;
        const int committed = committed_vehicle(model_, state_, conflict);
        const bool is_in_the_way =
            committed >= 0 &&
            (was_waiting_ || occupies_area_on_arrival(model_, state_, lane_, conflict, candidate_, committed));
        return is_in_the_way ? committed : -1;
    }

    // Returns how the candidate waits for a vehicle that is in the conflict area or enters it. Returns no wait if there
    // is no such vehicle. Also returns no wait if the area is beyond the decision distance (`is_far`), unless that
    // vehicle is slow or the candidate checks all areas in advance (`checks_all`).
    Wait blocked_wait(const Conflict& conflict, bool is_empty, bool checks_committed, bool is_far) {
        int blocker = is_empty ? -1 : area_blocker(conflict);
        if (blocker < 0 && checks_committed) blocker = committed_blocker(conflict);
        if (blocker < 0) return {};
        const bool blocker_is_slow = v_.speed_mps[at(blocker)] < kCrawlingSpeed_mps;
        const bool has_no_signal = state_.plan.signal_group_for(state_.plan.lane(lane_).origin, lane_) == 0;
        const bool checks_all = has_no_signal && (waits_at_line() || !is_imported_);
        if (is_far && !checks_all && !blocker_is_slow) return {};
        Wait wait{std::min(wait_m(conflict), line_m_), blocker, YieldReason::occupied};
        if (conflict.other_yields) wait.reason = YieldReason::intruder;
        // The gap behind a vehicle with priority begins when that vehicle reaches the area. So the candidate can
        // already accept the gap while the vehicle with priority is still in the area.
        // It starts at the earliest in the next step, and does not check the gap again then.
        if (conflict.yields && candidate_.stopped && !blocker_is_slow)
            wait.keeps_gap = gap_blocker(conflict, model_.step_s).slot < 0;
        return wait;
    }

    // Returns true if `occupant` may stop before it has left connection `other`. On the connection, the latest decision
    // tells. With its front beyond, the occupant may stop if the exit lane is shorter than a vehicle, because a wait at
    // the next intersection then keeps its rear here. The decision there is not read, because another thread may be
    // making it.
    bool may_have_to_wait(int other, const JunctionOccupant& occupant) const {
        const LanePlan& plan = state_.plan.lane(other);
        if (occupant.front_m <= plan.length_m) return had_to_wait(state_, occupant.slot);
        return state_.plan.lane(plan.exit).stop_line_m < state_.plan.max_space_per_vehicle_m();
    }

    // Returns true if the waiting place of the candidate is the stop line, but it need not wait there: all vehicles of
    // the other connection will have left the conflict area before the candidate reaches the position just before this
    // area. Returns false if `blocker` is slow, or if a vehicle that has not left the area yet is slow or has just had
    // to wait. Such a vehicle may stop before it has left the area.
    bool clears_area_in_time(const Conflict& conflict, int blocker) const {
        if (!waits_at_line() || v_.speed_mps[at(blocker)] < kCrawlingSpeed_mps) return false;
        for (const JunctionOccupant& occupant : occupants_of(state_, conflict.other)) {
            if (occupant.rear_m >= conflict.other_to_m) continue;
            const double speed_mps = v_.speed_mps[at(occupant.slot)];
            const double in_s =
                earliest_arrival_s(wait_m(conflict) - candidate_.front_m, speed_mps_,
                                   driver_.give_way.approach_acceleration_mps2, state_.plan.lane(lane_).limit_mps);
            const bool may_stop = speed_mps < kCrawlingSpeed_mps || may_have_to_wait(conflict.other, occupant);
            if (may_stop || (conflict.other_to_m - occupant.rear_m) / speed_mps > in_s) return false;
        }
        return true;
    }

    // Returns where the candidate must be able to stop behind the vehicles that merge into its exit lane ahead of it.
    Wait merging_wait(const Conflict& conflict, bool is_empty) {
        Wait nearest;
        if (conflict.zipper) {
            nearest = zipper_wait(model_, state_, lane_, candidate_, conflict);
            const bool goes_first =
                nearest.blocker >= 0 && find_resolution(state_, part_, candidate_.slot, nearest.blocker) != nullptr;
            return goes_first ? Wait{} : nearest;
        }
        const auto follow = [&](int slot, double front_m) {
            if (merges_first(state_, lane_, candidate_, conflict, slot, front_m)) return;
            keep_nearer({merging_stop_m(model_, state_, lane_, candidate_, conflict, slot, front_m), slot,
                         conflict.other_yields ? YieldReason::intruder : YieldReason::merging},
                        nearest);
        };
        if (!is_empty) {
            for (const JunctionOccupant& occupant : occupants_of(state_, conflict.other)) {
                if (blocks_area(model_, state_, part_, lane_, conflict, candidate_, occupant))
                    follow(occupant.slot, occupant.front_m);
            }
        }
        if (const int committed = committed_blocker(conflict); committed >= 0) {
            const int origin = state_.plan.lane(conflict.other).origin;
            follow(committed, v_.position_m[at(committed)] - state_.plan.lane(origin).length_m);
        }
        return nearest;
    }

    // Returns the waiting position furthest downstream, but not beyond `place_m`, where the candidate blocks no
    // conflict area. Two kinds of areas do not count: areas before which the candidate can no longer stop, and areas
    // shared with a connection whose signal is not green now.
    double clear_place_m(double place_m) const {
        const double length_m = v_.length_m[at(candidate_.slot)];
        // The stopping distance assumes deceleration_comfort, which is usually higher than stop.deceleration. A
        // candidate that already brakes with stop.deceleration for a waiting position can thus keep this position, even
        // if it deviates slightly from the braking curve.
        const double stopping_m =
            candidate_.stopped ? 0.0
                               : braking_distance_m(speed_mps_, 0.0, driver_.tables.cacc.deceleration_comfort_mps2);
        const std::span<const Conflict> conflicts = state_.plan.conflicts(lane_);
        for (std::size_t k = conflicts.size(); k-- > 0;) {
            const Conflict& conflict = conflicts[k];
            const bool would_block = conflict.from_m < place_m && conflict.to_m > place_m - length_m;
            if (!would_block || conflict.from_m - candidate_.front_m < stopping_m) continue;
            const int origin = state_.plan.lane(conflict.other).origin;
            const int group = state_.plan.signal_group_for(origin, conflict.other);
            if (state_.signals.lights[at(group)] == Light::green) place_m = wait_m(conflict);
        }
        return place_m;
    }

    // `delay_s`: the candidate can start only after this time.
    GapBlocker gap_blocker(const Conflict& conflict, double delay_s = 0.0) {
        const double place_m = is_imported_ ? std::min(wait_m(conflict), line_m_) : wait_m(conflict);
        return find_gap_blocker(model_, state_, part_, lane_, candidate_, place_m, delay_s);
    }

    const Model& model_;
    State& state_;
    Partition& part_;
    int lane_;
    const Candidate& candidate_;
    const VehicleArrays& v_;
    VehicleRecord& record_;
    const DriverPlan& driver_;  // driver of the candidate
    double speed_mps_;
    bool is_imported_;
    double line_m_ = kNoWait_m;
    double decision_m_ = 0.0;
    bool has_decided_ = false;
    bool was_waiting_ = false;
};

// Adds a yield stop of the vehicle in `slot` at `place_m` on `lane`. Also stores in the vehicle's record where, why and
// since when the vehicle waits, unless it only follows another vehicle (YieldReason::merging). A lane keeps only the
// stops of its first YieldStops::kCapacity waiting vehicles.
void record_wait(State& state, Partition& part, int lane, int slot, double place_m, const Wait& wait) {
    add_yield_stop(state.junctions, part, lane, {slot, place_m, wait.blocker, wait.reason});
    if (wait.reason == YieldReason::merging) return;
    VehicleRecord& record = state.vehicles.record[at(slot)];
    if (!had_to_wait(state, slot) || state.vehicles.speed_mps[at(slot)] >= kCrawlingSpeed_mps)
        record.wait_since_tick = static_cast<int>(state.tick);
    record.yield_tick = static_cast<int>(state.tick);
    record.yield_position_m =
        static_cast<float>(place_m - (state.plan.lane(lane).origin < 0 ? state.plan.lane(lane).length_m : 0.0));
    record.yield_reason = wait.reason;
}

// Drops the accepted gap of a candidate that has a wait and is stopped or can still stop, because vehicles with
// priority may arrive before the candidate starts again. The gap is kept if Wait::keeps_gap is set, or if the candidate
// only follows another vehicle (YieldReason::merging).
void drop_gap_if_stopping(const Model& model, State& state, int lane, const Candidate& candidate, const Wait& wait) {
    if (wait.keeps_gap || wait.reason == YieldReason::merging) return;
    const DriverPlan& driver = model.driver_of(state.vehicles.policy[at(candidate.slot)]);
    double room_m = wait.place_m - candidate.front_m;
    for (const Conflict& c : state.plan.conflicts(lane)) {
        const double to_area_m = c.from_m - driver.give_way.margin_m - candidate.front_m;
        if (c.yields && c.from_m >= candidate.front_m) room_m = std::min(room_m, to_area_m);
    }
    const double speed_mps = state.vehicles.speed_mps[at(candidate.slot)];
    const bool can_stop = reliable_stopping_distance_m(model, driver, speed_mps) <= room_m;
    if (candidate.stopped || can_stop) state.vehicles.record[at(candidate.slot)].accepted_gap_on = -1;
}

void decide(const Model& model, State& state, Partition& part, int lane) {
    const LanePlan& plan = state.plan.lane(lane);
    const LanePlan& origin = state.plan.lane(plan.origin);
    const VehicleArrays& v = state.vehicles;
    const LaneBlock& block = state.blocks[at(lane)];
    int ahead = -1;
    // `on_lane`: lane of the candidate, that is, the connection or its approach lane. `offset_m`: start of this lane,
    // measured from the start of the connection; negative for the approach lane.
    const auto decide_candidate = [&](const Candidate& candidate, int on_lane, double offset_m) {
        const Wait wait = WaitSearch(model, state, part, lane, candidate).find(ahead);
        if (!wait.exists()) return;
        if (wait.reason != YieldReason::merging) ahead = candidate.slot;
        drop_gap_if_stopping(model, state, lane, candidate, wait);
        record_wait(state, part, on_lane, candidate.slot, wait.place_m - offset_m, wait);
    };
    for (int slot = block.first; slot < block.past_last(); ++slot) {
        const bool is_slow = v.speed_mps[at(slot)] < kCrawlingSpeed_mps;
        decide_candidate({slot, v.position_m[at(slot)], true, is_slow}, lane, 0.0);
    }
    for (const int slot : part.approaching.at_place(state.junctions.approaching_place[at(lane)])) {
        const double position_m = v.position_m[at(slot)];
        decide_candidate({slot, position_m - origin.length_m, position_m > origin.stop_line_m,
                          v.speed_mps[at(slot)] < kCrawlingSpeed_mps},
                         plan.origin, -origin.length_m);
    }
}

}  // namespace

void decide_right_of_way(const Model& model, State& state, Partition& part) {
    // A resolution is kept for some steps after its last use, because the same two vehicles may meet again in a second
    // conflict area.
    constexpr std::int64_t kResolutionMemory_steps = 5;
    std::erase_if(part.deadlock_resolutions, [&](const DeadlockResolution& resolution) {
        return state.tick - resolution.last_needed_tick > kResolutionMemory_steps;
    });
    std::erase_if(part.blocker_passes, [&](const BlockerPass& pass) {
        return state.tick - pass.last_needed_tick > model.rules.memory_ticks;
    });
    clear_yield_stops(state.junctions, part);
    state.junctions.to_decide.retain_if(part.first_word, part.end_word, [&](std::size_t bit) {
        decide(model, state, part, state.plan.connection_at(bit));
        return false;
    });
    part.approaching.clear(state.junctions.approaching_place);
    stop_before_short_approaches(model, state, part);
    resolve_deadlocks(state, part);
    count_conflicts(model, state, part);
}

}  // namespace stopline
