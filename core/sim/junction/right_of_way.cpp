// Right of way inside intersections: decides which vehicles must wait, and before which conflict area. All decisions
// use the positions and speeds at the beginning of the step. On each connection only the first waiting vehicle checks
// gaps. The vehicles behind the first waiting vehicle wait for it where they must yield. They also keep out of occupied
// conflict areas.
//
// In a conflict area the connection of a vehicle meets another connection. The vehicle may enter the area under these
// conditions:
//   - No vehicle of the other connection is in the area. No vehicle of the other connection that has accepted a gap is
//     on its way to the area.
//   - If the vehicle must yield, it needs a gap: the next vehicle with priority must arrive at least one critical gap
//     after the yielding vehicle reaches its waiting position. The gap must suffice in all areas where the vehicle must
//     yield. The gap is checked again while the vehicle can still stop comfortably, because a stopped vehicle with
//     priority may start.
//   - If neither connection has priority (movements of different signal groups), the vehicle that was the first to pass
//     its stop line drives first. If two vehicles wait for each other, one of them proceeds (DeadlockResolution).
// The pass-blocker rule (driver/traffic_rules.h) lets a vehicle pass a vehicle that has been stopped inside the
// intersection for a long time.
#include "sim/junction/right_of_way.h"

#include <algorithm>
#include <cmath>

#include "base/containers/index.h"
#include "base/simd/arithmetic.h"
#include "base/speed_thresholds.h"
#include "sim/junction/arrivals.h"
#include "sim/junction/count_conflicts.h"
#include "sim/state/queries/stopping_distance.h"

namespace stopline {

namespace {

// Returns the time in s that a vehicle needs for a distance. A vehicle faster than `limit_mps`, the speed limit of its
// connection, brakes to the limit at the end of the distance. A slower vehicle keeps its speed, which is taken as at
// least kMinSpeed_mps.
double travel_time_s(const Model& model, double distance_m, double speed_mps, double limit_mps) {
    constexpr double kMinSpeed_mps = 2.0;
    const double b = model.driver.deceleration_mps2;
    const double slowing_m = 0.5 * (square(speed_mps) - square(limit_mps)) / b;
    if (slowing_m <= 0.0) return std::max(distance_m, 0.0) / std::max(speed_mps, kMinSpeed_mps);
    if (distance_m >= slowing_m) return (distance_m - slowing_m) / speed_mps + (speed_mps - limit_mps) / b;
    return (speed_mps - std::sqrt(square(speed_mps) - 2.0 * b * std::max(distance_m, 0.0))) / b;
}

// A vehicle for which right of way is decided.
struct Candidate {
    int slot;
    double front_m;  // front position along the connection; below 0: on the approach lane
    bool inside;     // true: the front is past the stop line
    bool stopped;    // true: slower than kCrawlingSpeed_mps
};

// Returns true if the pass-blocker rule lets `vehicle` on connection `lane` pass `blocker` on connection `other`. The
// blocker must have been stopped for a long time, and the connections must lead to different exit lanes. A permission
// stays valid when the blocker starts, because the passing vehicle may then be unable to stop.
bool may_pass(const Model& model, State& state, Partition& part, int vehicle, int lane, int blocker, int other) {
    const VehicleArrays& v = state.vehicles;
    if (model.rules.pass_blocker_ticks == 0) return false;
    for (BlockerPass& known : part.blocker_passes) {
        if (known.vehicle != v.id[at(vehicle)] || known.blocker != v.id[at(blocker)]) continue;
        known.last_needed_tick = state.tick;
        return true;
    }
    const std::int64_t stood = state.tick - v.stopped_since[at(blocker)];
    if (stood < model.rules.pass_blocker_ticks) return false;
    if (state.plan.lane(lane).exit == state.plan.lane(other).exit) return false;
    part.blocker_passes.push_back({v.id[at(vehicle)], v.id[at(blocker)], state.tick, stood, false});
    return true;
}

// Returns the deadlock resolution that lets the vehicle in `first_slot` proceed and the vehicle in `second_slot` wait;
// nullptr: none.
DeadlockResolution* find_resolution(const State& state, Partition& part, int first_slot, int second_slot) {
    const VehicleArrays& v = state.vehicles;
    const auto found = std::find_if(
        part.deadlock_resolutions.begin(), part.deadlock_resolutions.end(), [&](const DeadlockResolution& resolution) {
            return resolution.proceeds == v.id[at(first_slot)] && resolution.yields == v.id[at(second_slot)];
        });
    return found == part.deadlock_resolutions.end() ? nullptr : &*found;
}

// Returns the slot of a vehicle on connection `conflict.other` that keeps candidate `v` out of the conflict area; -1:
// none. The gap to approaching vehicles with priority is checked elsewhere (near_priority_vehicle()).
int area_blocker(const Model& model, State& state, Partition& part, int lane, const Conflict& conflict,
                 const Candidate& v) {
    const std::int64_t since = state.vehicles.record[at(v.slot)].junction_entry_tick;
    const int stopping = state.stop_lines.stop_slot[at(state.plan.lane(conflict.other).origin)];
    for (const JunctionOccupant& occupant : state.junctions.occupants[at(conflict.other)]) {
        if (occupant.rear_m >= conflict.other_to_m) continue;
        if (may_pass(model, state, part, v.slot, lane, occupant.slot, conflict.other)) continue;
        if (occupant.front_m > conflict.other_from_m) return occupant.slot;
        if (conflict.yields || occupant.slot == stopping) continue;
        if (conflict.other_yields) {
            const bool has_gap = state.vehicles.record[at(occupant.slot)].accepted_gap_on == conflict.other &&
                                 !is_yielding_before(state, occupant.slot, conflict.other_from_m);
            if (has_gap) return occupant.slot;
            continue;
        }
        // Neither connection has priority. If both vehicles wait for each other, a deadlock resolution decides which
        // vehicle proceeds.
        if (find_resolution(state, part, occupant.slot, v.slot) != nullptr) return occupant.slot;
        if (DeadlockResolution* const resolution = find_resolution(state, part, v.slot, occupant.slot)) {
            resolution->last_needed_tick = state.tick;  // the resolution must not expire
            continue;
        }
        // If the candidate and the occupant both wait, a new resolution lets the candidate proceed.
        if (v.stopped &&
            (is_yielding(state, occupant.slot) || is_behind_yielding_vehicle(state, conflict.other, occupant))) {
            part.deadlock_resolutions.push_back(
                {state.vehicles.id[at(v.slot)], state.vehicles.id[at(occupant.slot)], state.tick});
            continue;
        }
        const bool entered_earlier = occupant.since < since || (occupant.since == since && occupant.slot < v.slot);
        if (!v.inside || entered_earlier) return occupant.slot;
    }
    return -1;
}

// Returns the time in s by which crossing the conflict area at the speed limit of the connection takes longer than the
// critical gap, for example in a U-turn. The caller adds this time to the critical gap. Returns 0 in networks without
// trips. These are not imported, and their conflict areas are short.
double slow_crossing_extra_gap_s(const Model& model, int lane, const Conflict& conflict, double limit_mps,
                                 double length_m) {
    constexpr double kSpare_s = 1.5;
    if (model.demand.trips.empty() || model.graph.lanes[at(lane)].origin < 0) return 0.0;
    const double through_s = (conflict.to_m - conflict.from_m + length_m) / limit_mps + kSpare_s;
    return std::max(through_s - model.give_way.critical_gap_s, 0.0);
}

// Returns the slot of a vehicle that has accepted a gap although it must yield to candidate `v`; -1: none. A stopped
// candidate lets this vehicle go first. Otherwise several stopped vehicles could give way to each other in a cycle and
// never start.
int yield_cycle_winner(const Model& model, const State& state, int lane, const Candidate& v) {
    if (model.demand.trips.empty() || !v.stopped) return -1;
    for (const Conflict& conflict : state.plan.conflicts(lane)) {
        if (!conflict.other_yields) continue;
        const LaneBlock& block = state.blocks[at(state.plan.lane(conflict.other).origin)];
        if (block.count == 0 || is_yielding(state, block.first)) continue;
        const VehicleArrays& arrays = state.vehicles;
        if (arrays.next_lane[at(block.first)] != conflict.other) continue;
        if (arrays.record[at(block.first)].accepted_gap_on == conflict.other) return block.first;
    }
    return -1;
}

// Returns the slot of a vehicle without priority that approaches connection `conflict.other`, has accepted a gap, and
// can no longer stop before the first conflict area of this connection; -1: none. The accepted gap may have become too
// short, because a stopped vehicle with priority may have started after the gap was accepted.
int committed_vehicle(const Model& model, const State& state, const Conflict& conflict) {
    const VehicleArrays& v = state.vehicles;
    const LanePlan& origin = state.plan.lane(state.plan.lane(conflict.other).origin);
    const LaneBlock& block = state.blocks[at(state.plan.lane(conflict.other).origin)];
    for (int slot = block.first; slot < block.past_last(); ++slot) {
        if (v.next_lane[at(slot)] != conflict.other) continue;
        const double speed_mps = v.speed_mps[at(slot)];
        const double first_m = state.plan.lane(conflict.other).first_conflict_m - model.give_way.margin_m;
        const double to_area_m = origin.length_m + first_m - v.position_m[at(slot)];
        const bool is_moving_through =
            v.record[at(slot)].accepted_gap_on == conflict.other && speed_mps >= kCrawlingSpeed_mps;
        return is_moving_through && to_area_m < comfortable_braking_distance_m(model, speed_mps) ? slot : -1;
    }
    return -1;
}

// Returns the slot of the vehicle to which candidate `v` must yield; -1: none. This is a vehicle with priority that
// arrives too soon, or the vehicle that yield_cycle_winner() returns. Stores in the record of the candidate whether the
// candidate accepts the gap.
int near_priority_vehicle(const Model& model, State& state, Partition& part, int lane, const Candidate& v,
                          double to_wait_m) {
    VehicleArrays& arrays = state.vehicles;
    VehicleRecord& record = arrays.record[at(v.slot)];
    const double limit_mps = state.plan.lane(lane).limit_mps;
    const double needed_s =
        model.give_way.critical_gap_s + travel_time_s(model, to_wait_m, arrays.speed_mps[at(v.slot)], limit_mps);
    const bool had_accepted_gap = record.accepted_gap_on == lane;
    record.accepted_gap_on = -1;
    if (const int winner = yield_cycle_winner(model, state, lane, v); winner >= 0) return winner;
    Arrival next;
    for (const Conflict& conflict : state.plan.conflicts(lane)) {
        if (!conflict.yields || v.front_m > conflict.from_m) continue;
        const double until_s =
            needed_s + slow_crossing_extra_gap_s(model, lane, conflict, limit_mps, arrays.length_m[at(v.slot)]);
        const Arrival arrival = next_arrival(model, state, conflict, until_s);
        next.keep_earlier(arrival.time_s, arrival.slot);
        if (arrival.time_s < until_s) return arrival.slot;
    }
    record.accepted_gap_on = lane;
    // Clear the yielding state at once. Several vehicles may yield to each other in a cycle, and the other vehicles of
    // the cycle must see that this vehicle proceeds.
    if (!model.demand.trips.empty()) record.yield_tick = -2;
    if (!model.records_all || had_accepted_gap) return -1;
    part.gaps_accepted.push_back({model.time_s(state.tick), arrays.id[at(v.slot)], lane,
                                  static_cast<float>(next.time_s), static_cast<float>(needed_s)});
    return -1;
}

// Returns true if the committed vehicle in slot `other` will still be in the conflict area at the earliest time at
// which candidate `v`, which has priority, can arrive. This can happen if the committed vehicle is later or slower than
// was predicted when it accepted its gap.
bool occupies_area_on_arrival(const Model& model, const State& state, int lane, const Conflict& conflict,
                              const Candidate& v, int other) {
    const VehicleArrays& arrays = state.vehicles;
    const LanePlan& other_plan = state.plan.lane(conflict.other);
    const double in_s = earliest_arrival_s(std::max(conflict.from_m - v.front_m, 0.0), arrays.speed_mps[at(v.slot)],
                                           model.give_way.approach_acceleration_mps2, state.plan.lane(lane).limit_mps);
    const double speed_mps = arrays.speed_mps[at(other)];
    const double to_connection_m = state.plan.lane(other_plan.origin).length_m - arrays.position_m[at(other)];
    const double through_m = conflict.other_to_m + arrays.length_m[at(other)];
    return travel_time_s(model, to_connection_m, speed_mps, other_plan.limit_mps) +
               through_m / std::min(speed_mps, other_plan.limit_mps) >
           in_s;
}

constexpr double kNoWait_m = 1e9;  // stands for the waiting position of a vehicle that need not wait

// The position where a candidate must wait, and the vehicle for which it waits.
struct Wait {
    double place_m = kNoWait_m;  // waiting position along the connection; kNoWait_m: the candidate need not wait
    int blocker = -1;            // slot of the vehicle for which the candidate waits
    // True: the candidate must let the blocker go first, or the blocker waits ahead on the same connection. False: the
    // blocker is in the conflict area or about to enter it.
    bool blocker_has_priority = false;
};

// Returns the waiting position at the stop line, m along the connection. Returns kNoWait_m if vehicles may wait inside
// the intersection on this connection, or if the candidate can no longer stop at the line.
double stop_line_wait_m(const Model& model, const State& state, int lane, const Candidate& v) {
    if (v.inside || state.plan.may_wait_inside(lane)) return kNoWait_m;
    const LanePlan& origin = state.plan.lane(state.plan.lane(lane).origin);
    const double line_m = origin.stop_line_m - origin.length_m - model.driver.stop.margin_m;
    const double speed_mps = state.vehicles.speed_mps[at(v.slot)];
    return v.stopped || line_m - v.front_m >= comfortable_braking_distance_m(model, speed_mps) ? line_m : kNoWait_m;
}

// Returns where candidate `v` must wait, and for which vehicle. `ahead`: slot of a waiting vehicle further ahead on the
// same connection, -1: none. Where the candidate must yield, it waits for the vehicle `ahead` without checking gaps.
Wait find_wait(const Model& model, State& state, Partition& part, int lane, const Candidate& v, int ahead) {
    VehicleArrays& arrays = state.vehicles;
    const double speed = arrays.speed_mps[at(v.slot)];
    const double margin_m = model.give_way.margin_m;
    const double decision_m = decision_distance_m(model, speed);
    // A vehicle behind a stopped leader cannot use its accepted gap. Drop the gap, so that other vehicles do not wait
    // for this vehicle.
    if (v.stopped && is_blocked_by_leader(state, v.slot)) arrays.record[at(v.slot)].accepted_gap_on = -1;
    bool has_decided = arrays.record[at(v.slot)].accepted_gap_on == lane;
    const double to_first_m = state.plan.lane(lane).first_conflict_m - margin_m - v.front_m;
    if (!v.stopped && to_first_m > comfortable_braking_distance_m(model, speed)) has_decided = false;
    const bool has_others_inside = state.junctions.occupied.has_any(state.plan.conflicting(lane));
    const double line_m = stop_line_wait_m(model, state, lane, v);
    const bool waits_at_line = line_m < kNoWait_m;
    const bool has_no_signal = state.plan.signal_group_for(state.plan.lane(lane).origin, lane) == 0;
    if (waits_at_line && line_m - v.front_m > decision_m) return {};
    const bool was_waiting = v.stopped || arrays.record[at(v.slot)].yield_tick >= state.tick - 1;
    const double braking_m = emergency_braking_distance_m(model, speed);
    const bool checks_committed = was_waiting || !model.demand.trips.empty();
    if (!has_others_inside && !checks_committed && (has_decided || !state.plan.lane(lane).yields)) return {};
    for (const Conflict& conflict : state.plan.conflicts(lane)) {
        const double wait_m = conflict.from_m - margin_m;
        if (v.front_m > conflict.from_m) continue;
        const bool is_far = wait_m - v.front_m > decision_m;
        if (is_far && !waits_at_line) break;
        const bool is_empty = !has_others_inside || state.junctions.occupants[at(conflict.other)].empty();
        int blocker = is_empty ? -1 : area_blocker(model, state, part, lane, conflict, v);
        if (blocker < 0 && checks_committed && conflict.other_yields && conflict.from_m - v.front_m >= braking_m) {
            const int committed = committed_vehicle(model, state, conflict);
            if (committed >= 0 &&
                (was_waiting || occupies_area_on_arrival(model, state, lane, conflict, v, committed))) {
                blocker = committed;
            }
        }
        const bool is_relevant =
            !is_far || has_no_signal || (blocker >= 0 && arrays.speed_mps[at(blocker)] < kCrawlingSpeed_mps);
        if (blocker >= 0 && is_relevant) return {std::min(wait_m, line_m), blocker, false};
        if (conflict.yields && !has_decided) {
            const int priority_slot =
                ahead >= 0 ? ahead : near_priority_vehicle(model, state, part, lane, v, wait_m - v.front_m);
            if (priority_slot >= 0) return {std::min(wait_m, line_m), priority_slot, true};
            has_decided = true;
        }
    }
    return {};
}

// Stores in the record of a vehicle that the vehicle waits, and adds a yield stop at `place_m` on `lane`. A lane keeps
// only the stops of its first few waiting vehicles.
void record_wait(State& state, Partition& part, int lane, int slot, double place_m, const Wait& wait) {
    VehicleRecord& record = state.vehicles.record[at(slot)];
    record.yield_tick = static_cast<int>(state.tick);
    record.yield_position_m =
        static_cast<float>(place_m - (state.plan.lane(lane).origin < 0 ? state.plan.lane(lane).length_m : 0.0));
    add_yield_stop(state.junctions, part, lane, {slot, place_m, wait.blocker, wait.blocker_has_priority});
}

void decide(const Model& model, State& state, Partition& part, int lane) {
    const LanePlan& plan = state.plan.lane(lane);
    const LanePlan& origin = state.plan.lane(plan.origin);
    const VehicleArrays& v = state.vehicles;
    const LaneBlock& block = state.blocks[at(lane)];
    int ahead = -1;
    const auto decide_candidate = [&](const Candidate& candidate) {
        const Wait found = find_wait(model, state, part, lane, candidate, ahead);
        if (found.place_m < kNoWait_m) {
            ahead = candidate.slot;
            // Drop the accepted gap of a vehicle that will stop. Vehicles with priority may arrive before this vehicle
            // starts again.
            double room_m = found.place_m - candidate.front_m;
            for (const Conflict& c : state.plan.conflicts(lane)) {
                const double to_area_m = c.from_m - model.give_way.margin_m - candidate.front_m;
                if (c.yields && c.from_m >= candidate.front_m) room_m = std::min(room_m, to_area_m);
            }
            const bool can_stop = reliable_stopping_distance_m(model, v.speed_mps[at(candidate.slot)]) <= room_m;
            if (candidate.stopped || can_stop) state.vehicles.record[at(candidate.slot)].accepted_gap_on = -1;
        }
        return found;
    };
    for (int slot = block.first; slot < block.past_last(); ++slot) {
        const Wait found =
            decide_candidate({slot, v.position_m[at(slot)], true, v.speed_mps[at(slot)] < kCrawlingSpeed_mps});
        if (found.place_m < kNoWait_m) record_wait(state, part, lane, slot, found.place_m, found);
    }
    std::vector<int>& approaching = state.junctions.approaching[at(lane)];
    for (const int slot : approaching) {
        const double position_m = v.position_m[at(slot)];
        const Candidate candidate{slot, position_m - origin.length_m, position_m > origin.stop_line_m,
                                  v.speed_mps[at(slot)] < kCrawlingSpeed_mps};
        const Wait found = decide_candidate(candidate);
        if (found.place_m < kNoWait_m)
            record_wait(state, part, plan.origin, slot, found.place_m + origin.length_m, found);
    }
    approaching.clear();
}

}  // namespace

void decide_right_of_way(const Model& model, State& state, Partition& part) {
    // A resolution is kept for some steps, because the same two vehicles may meet again in a second conflict area.
    constexpr std::int64_t kResolutionMemory_steps = 5;
    std::erase_if(part.deadlock_resolutions, [&](const DeadlockResolution& resolution) {
        return state.tick - resolution.last_needed_tick > kResolutionMemory_steps;
    });
    std::erase_if(part.blocker_passes, [&](const BlockerPass& pass) {
        return state.tick - pass.last_needed_tick > model.rules.memory_ticks;
    });
    for (const int lane : part.lanes_with_yield_stops) {
        state.junctions.yield_stops[at(lane)].count = 0;
        state.junctions.has_yield_stops[at(lane)] = 0;
    }
    part.lanes_with_yield_stops.clear();
    state.junctions.to_decide.retain_if(part.first_word, part.end_word, [&](std::size_t bit) {
        decide(model, state, part, state.plan.connection_at(bit));
        return false;
    });
    count_conflicts(model, state, part);
}

}  // namespace stopline
