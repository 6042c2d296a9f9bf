#include "sim/junction/gap_acceptance.h"

#include <algorithm>
#include <cmath>

#include "base/containers/index.h"
#include "base/simd/arithmetic.h"
#include "base/speed_thresholds.h"
#include "sim/junction/arrivals.h"
#include "sim/junction/deadlocks.h"
#include "sim/junction/merging.h"
#include "sim/state/queries/stopping_distance.h"

namespace stopline {

namespace {

// A vehicle has reached its waiting position if its front is at most this far before it.
constexpr double kWaitingTolerance_m = 1.0;

// Returns the travel time over a distance, s. A vehicle faster than `limit_mps`, the speed limit of its connection,
// brakes towards the limit. A slower vehicle keeps its speed, but drives at kMinSpeed_mps at least.
double travel_time_s(const DriverPlan& driver, double distance_m, double speed_mps, double limit_mps) {
    constexpr double kMinSpeed_mps = 2.0;
    const double b = driver.tables.deceleration_mps2;
    const double slowing_m = 0.5 * (square(speed_mps) - square(limit_mps)) / b;
    if (slowing_m <= 0.0) return std::max(distance_m, 0.0) / std::max(speed_mps, kMinSpeed_mps);
    if (distance_m >= slowing_m) return (distance_m - slowing_m) / speed_mps + (speed_mps - limit_mps) / b;
    return (speed_mps - std::sqrt(square(speed_mps) - 2.0 * b * std::max(distance_m, 0.0))) / b;
}

// Returns the time in s since a vehicle of connection `conflict.other` most recently arrived in the conflict area.
// Returns 0 if no vehicle of this connection is in the area now. The time is computed as if the vehicle had driven at
// the speed limit, so it is rather too short than too long.
double time_since_last_arrival_s(const State& state, const Conflict& conflict) {
    double since_s = 0.0;
    for (const JunctionOccupant& occupant : occupants_of(state, conflict.other)) {
        if (occupant.front_m > conflict.other_from_m && occupant.rear_m < conflict.other_to_m)
            since_s = (occupant.front_m - conflict.other_from_m) / state.plan.lane(conflict.other).limit_mps;
    }
    return since_s;
}

// Returns the time in s after which `candidate` no longer hinders the next vehicle with priority, if it is at `front_m`
// with `speed_mps` now. For a crossing vehicle, this is the time until it has left the conflict area. For a merging
// vehicle, it is the time until this vehicle reaches the area, plus a reserve in which it speeds up.
double passing_time_s(const Model& model, const State& state, int lane, const Conflict& conflict,
                      const Candidate& candidate, double front_m, double speed_mps) {
    constexpr double kMergingReserve_s = 1.0;  // our choice
    const double length_m = state.vehicles.length_m[at(candidate.slot)];
    const GiveWaySettings& give_way = model.driver_of(state.vehicles.policy[at(candidate.slot)]).give_way;
    const bool merges = is_merge(model, state, lane, conflict);
    const double distance_m = (merges ? conflict.from_m : conflict.to_m + length_m) - front_m;
    const double time_s = earliest_arrival_s(std::max(distance_m, 0.0), speed_mps, give_way.approach_acceleration_mps2,
                                             state.plan.lane(lane).limit_mps);
    return merges ? time_s + kMergingReserve_s : time_s;
}

// Returns the shortest gap in s that leaves a vehicle with priority the time for an emergency stop. This vehicle drives
// at the speed limit, and responds one step after the gap has been accepted.
double emergency_stop_gap_s(const Model& model, const State& state, const Conflict& conflict) {
    const double speed_mps = state.plan.free_speed_mps(state.plan.lane(conflict.other).origin);
    return model.step_s + emergency_stopping_distance_m(model, speed_mps) / speed_mps;
}

// Returns the earliest arrival time of the next vehicle with priority, in s from now, at which `candidate` still
// accepts the gap. `wait_m`: waiting position of the candidate. `delay_s`: the candidate can start only after this
// time. `has_begun`: the candidate is moving and uses a gap that it has accepted before.
// As in the Highway Capacity Manual, the gap begins when the previous vehicle with priority has reached the area. If
// this vehicle has left the area, the gap begins now. The critical gap holds for a vehicle that starts from rest at
// `wait_m`. A candidate that needs more time than this vehicle to pass the area needs a longer gap, by the difference.
// A faster candidate needs a shorter gap. If the driver has a critical lag, this lag replaces the critical gap while
// the candidate moves.
double needed_time_s(const Model& model, const State& state, int lane, const Conflict& conflict,
                     const Candidate& candidate, double wait_m, double delay_s, bool has_begun) {
    const VehicleArrays& v = state.vehicles;
    const double speed_mps = v.speed_mps[at(candidate.slot)];
    const DriverPlan& driver = model.driver_of(v.policy[at(candidate.slot)]);
    const double passing_s = passing_time_s(model, state, lane, conflict, candidate, candidate.front_m, speed_mps);
    if (has_begun && model.is_imported()) return passing_s;
    const double to_wait_s =
        travel_time_s(driver, wait_m - candidate.front_m, speed_mps, state.plan.lane(lane).limit_mps);
    const double from_rest_s = passing_time_s(model, state, lane, conflict, candidate, wait_m, 0.0);
    const double gap_s =
        driver.give_way.critical_lag_s > 0.0 && !candidate.stopped
            ? to_wait_s + driver.give_way.critical_lag_s
            : driver.give_way.critical_gap_s - time_since_last_arrival_s(state, conflict) + passing_s - from_rest_s;
    // With this gap, the candidate does not hinder the next vehicle with priority.
    const double unhindered_s = has_begun ? passing_s : std::max(gap_s, passing_s);
    if (model.is_imported()) return unhindered_s;
    // In other networks, a candidate that has reached its waiting position may make the next vehicle with priority
    // brake. When the candidate reaches this position, that vehicle must have the time for an emergency stop.
    const double stop_s = emergency_stop_gap_s(model, state, conflict) + to_wait_s + delay_s;
    const bool is_at_wait = candidate.front_m >= wait_m - kWaitingTolerance_m;
    return std::max(is_at_wait ? std::min(gap_s, unhindered_s) : unhindered_s, stop_s);
}

// Imported networks only: returns the slot of a vehicle that must yield to `candidate` but has already accepted a gap;
// -1: none, or the candidate is moving. A stopped candidate lets this vehicle go first. Otherwise several stopped
// vehicles could give way to each other in a cycle and never start.
int yield_cycle_winner(const Model& model, const State& state, int lane, const Candidate& candidate) {
    if (!model.is_imported() || !candidate.stopped) return -1;
    for (const Conflict& conflict : state.plan.conflicts(lane)) {
        if (!conflict.other_yields) continue;
        const int origin = state.plan.lane(conflict.other).origin;
        const LaneBlock& block = state.blocks[at(origin)];
        if (block.count == 0 || is_yielding(state, block.first)) continue;
        // A vehicle that stops at its line cannot use its gap.
        if (block.first == state.stop_lines.stop_slot[at(origin)]) continue;
        const VehicleArrays& v = state.vehicles;
        if (v.next_lane[at(block.first)] != conflict.other) continue;
        if (v.record[at(block.first)].accepted_gap_on == conflict.other) return block.first;
    }
    return -1;
}

}  // namespace

GapBlocker find_gap_blocker(const Model& model, State& state, Partition& part, int lane, const Candidate& candidate,
                            double wait_m, double delay_s) {
    VehicleArrays& v = state.vehicles;
    VehicleRecord& record = v.record[at(candidate.slot)];
    const bool had_accepted_gap = record.accepted_gap_on == lane;
    const bool has_begun = had_accepted_gap && !candidate.stopped;
    record.accepted_gap_on = -1;
    DeadlockResolution* const resolution =
        candidate.stopped ? find_resolution_for(state, part, candidate.slot) : nullptr;
    if (resolution != nullptr) {
        resolution->last_needed_tick = state.tick;
    } else if (const int winner = yield_cycle_winner(model, state, lane, candidate); winner >= 0) {
        return {winner, YieldReason::intruder};
    }
    const double acceleration_mps2 = model.driver_of(v.policy[at(candidate.slot)]).give_way.approach_acceleration_mps2;
    Arrival next;
    double next_needed_s = 0.0;
    for (const Conflict& conflict : state.plan.conflicts(lane)) {
        if (!conflict.yields || candidate.front_m > conflict.from_m) continue;
        const double until_s = needed_time_s(model, state, lane, conflict, candidate, wait_m, delay_s, has_begun);
        const Arrival arrival = next_arrival(
            model, state, conflict,
            {.horizon_s = until_s, .acceleration_mps2 = acceleration_mps2, .ignores_crawling = resolution != nullptr});
        next.keep_earlier(arrival.time_s, arrival.slot);
        next_needed_s = std::max(next_needed_s, until_s);
        if (arrival.time_s < until_s) return {arrival.slot, YieldReason::priority};
    }
    record.accepted_gap_on = lane;
    // Imported networks: clear the yielding state at once. If stopped vehicles yield to each other in a cycle, the
    // others then see that this vehicle proceeds.
    if (model.is_imported()) record.yield_tick = kNeverYielded_tick;
    if (!model.records_all || had_accepted_gap) return {};
    part.gaps_accepted.push_back({model.time_s(state.tick), v.id[at(candidate.slot)], lane,
                                  static_cast<float>(next.time_s), static_cast<float>(next_needed_s)});
    return {};
}

int committed_vehicle(const Model& model, const State& state, const Conflict& conflict) {
    const VehicleArrays& v = state.vehicles;
    const LanePlan& origin = state.plan.lane(state.plan.lane(conflict.other).origin);
    const LaneBlock& block = state.blocks[at(state.plan.lane(conflict.other).origin)];
    for (int slot = block.first; slot < block.past_last(); ++slot) {
        if (v.next_lane[at(slot)] != conflict.other) continue;
        const double speed_mps = v.speed_mps[at(slot)];
        const DriverPlan& driver = model.driver_of(v.policy[at(slot)]);
        const double first_m = state.plan.lane(conflict.other).first_conflict_m - driver.give_way.margin_m;
        const double to_area_m = origin.length_m + first_m - v.position_m[at(slot)];
        const bool is_moving_through =
            v.record[at(slot)].accepted_gap_on == conflict.other && speed_mps >= kCrawlingSpeed_mps;
        return is_moving_through && to_area_m < comfortable_braking_distance_m(driver, speed_mps) ? slot : -1;
    }
    return -1;
}

bool occupies_area_on_arrival(const Model& model, const State& state, int lane, const Conflict& conflict,
                              const Candidate& candidate, int other) {
    const VehicleArrays& v = state.vehicles;
    const DriverPlan& driver = model.driver_of(v.policy[at(candidate.slot)]);
    const LanePlan& other_plan = state.plan.lane(conflict.other);
    const double in_s =
        earliest_arrival_s(std::max(conflict.from_m - candidate.front_m, 0.0), v.speed_mps[at(candidate.slot)],
                           driver.give_way.approach_acceleration_mps2, state.plan.lane(lane).limit_mps);
    const double speed_mps = v.speed_mps[at(other)];
    const double to_connection_m = state.plan.lane(other_plan.origin).length_m - v.position_m[at(other)];
    const double through_m = conflict.other_to_m + v.length_m[at(other)];
    return travel_time_s(model.driver_of(v.policy[at(other)]), to_connection_m, speed_mps, other_plan.limit_mps) +
               through_m / std::min(speed_mps, other_plan.limit_mps) >
           in_s;
}

}  // namespace stopline
