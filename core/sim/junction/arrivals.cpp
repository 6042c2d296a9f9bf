#include "sim/junction/arrivals.h"

#include <algorithm>
#include <cmath>

#include "base/containers/index.h"
#include "base/simd/arithmetic.h"
#include "base/speed_thresholds.h"
#include "sim/perception/look_ahead.h"
#include "sim/state/queries/gap.h"
#include "sim/state/queries/vehicle_place.h"

namespace stopline {

namespace {

// A slow vehicle is blocked by its slow leader if the net gap is below kCloseBehind_m, or if it exceeds the standstill
// gap of the vehicle's policy by less than kNearStandstillGap_m.
constexpr double kCloseBehind_m = 6.0;
constexpr double kNearStandstillGap_m = 3.0;
}  // namespace

bool is_yielding(const State& state, int slot) {
    return had_to_wait(state, slot) && state.vehicles.speed_mps[at(slot)] < kCrawlingSpeed_mps;
}

bool is_yielding_before(const State& state, int slot, double area_m) {
    return is_yielding(state, slot) && state.vehicles.record[at(slot)].yield_position_m <= static_cast<float>(area_m);
}

double earliest_arrival_s(double distance_m, double speed_mps, double acceleration_mps2, double limit_mps) {
    const double to_limit_mps = std::max(limit_mps - speed_mps, 0.0);
    const double to_limit_m = to_limit_mps * (speed_mps + 0.5 * to_limit_mps) / acceleration_mps2;
    if (distance_m <= to_limit_m) {
        return (std::sqrt(square(speed_mps) + 2.0 * acceleration_mps2 * distance_m) - speed_mps) / acceleration_mps2;
    }
    return to_limit_mps / acceleration_mps2 + (distance_m - to_limit_m) / std::max(limit_mps, speed_mps);
}

bool is_blocked_by_leader(const State& state, int slot) {
    const VehicleArrays& v = state.vehicles;
    const std::size_t i = at(slot);
    const double close_m = std::max(kCloseBehind_m, v.standstill_gap_m[i] + kNearStandstillGap_m);
    return v.record[i].leader_id >= 0 && v.speed_mps[i] < kCrawlingSpeed_mps &&
           v.speed_mps[i - 1] < kCrawlingSpeed_mps && net_gap_m(v, i - 1, i) < close_m;
}

double queue_look_ahead_m(const State& state, int slot) {
    constexpr double kShortest_m = 20.0;
    constexpr double kBeyondStandstillGap_m = 17.0;
    return std::max(kShortest_m, state.vehicles.standstill_gap_m[at(slot)] + kBeyondStandstillGap_m);
}

namespace {

// Returns true if the vehicle is on a lane of the intersection to which `lane` belongs. The yielding state of a vehicle
// at another intersection cannot be used, because another thread may or may not have updated it yet.
bool is_at_same_intersection(const State& state, int lane, int slot) {
    return state.plan.intersection_of(lane_of(state, slot)) == state.plan.intersection_of(lane);
}

}  // namespace

bool is_behind_yielding_vehicle(const State& state, int lane, const JunctionOccupant& occupant) {
    constexpr int kMaxQueue = 8;  // longest queue that is searched, in vehicles
    const auto is_on = [&](int on_lane, int vehicle) { return state.blocks[at(on_lane)].has(vehicle); };
    int slot = occupant.slot;
    int current_lane = is_on(lane, slot) ? lane : state.plan.lane(lane).origin;
    if (!is_on(current_lane, slot)) return false;  // the front is on the exit lane
    for (int k = 0; k < kMaxQueue && is_blocked_by_leader(state, slot); ++k) {
        const LaneBlock& block = state.blocks[at(current_lane)];
        if (slot == block.first) {
            slot = leader_ahead(state, current_lane, slot, queue_look_ahead_m(state, slot)).slot;
            if (!is_on(lane, slot))
                return slot >= 0 && is_at_same_intersection(state, lane, slot) && is_yielding(state, slot);
            current_lane = lane;
        } else {
            --slot;
        }
        if (is_yielding(state, slot)) return true;
    }
    return false;
}

namespace {

// Returns true if the vehicle yields (is_yielding()), but not to an intruder (YieldReason::intruder). An intruder is a
// vehicle that must itself yield but goes first, for example because it can no longer stop. If the result is true,
// vehicles that must yield to this vehicle may go before it.
bool lets_others_go(const State& state, int slot) {
    return is_yielding(state, slot) && state.vehicles.record[at(slot)].yield_reason != YieldReason::intruder;
}

// Returns the slot of a vehicle that stops at the stop line of `lane`, so that the vehicles behind it cannot reach
// `connection`; -1: none. While the signal of `connection` is green, a stopping vehicle counts only if it takes another
// connection whose signal is not green.
int vehicle_stopping_at_signal(const State& state, int lane, int connection) {
    const int stopping = state.stop_lines.stop_slot[at(lane)];
    if (state.signals.lights[at(state.plan.signal_group_for(lane, connection))] != Light::green) return stopping;
    if (stopping < 0 || !state.plan.lane(lane).has_movement_signals) return -1;
    const int next = state.vehicles.next_lane[at(stopping)];
    return state.signals.lights[at(state.plan.signal_group_for(lane, next))] == Light::green ? -1 : stopping;
}

// Returns the slot of a vehicle that is held at rest at the stop line of `lane`; -1: none. Vehicles that must yield to
// the held vehicle may go first. Such a vehicle is refused by cooperative clearing, and announces this by V2V. In
// imported networks it can also be held by the keep-clear rule.
int vehicle_held_at_rest(const Model& model, const State& state, int lane) {
    const KeepClearHold& hold = state.stop_lines.held_at_green[at(lane)];
    if (!hold.is_refusal && (!model.is_imported() || hold.blocker < 0)) return -1;
    const int held = state.stop_lines.stop_slot[at(lane)];
    return held >= 0 && state.vehicles.speed_mps[at(held)] < kCrawlingSpeed_mps ? held : -1;
}

// The arguments of one call of look_upstream(). The function searches upstream of `lane` for moving vehicles that will
// drive over `lane` to `connection`. The function does not read decisions of this step about these vehicles, because
// another thread may be making these decisions at the same time.
struct Upstream {
    int lane;
    int connection;
    double to_area_m;  // distance from the start of `lane` to the conflict area
    int depth;         // recursion depth of the call; 0: first call
};

void look_upstream(const Model& model, const State& state, const Upstream& here, const ArrivalSearch& search,
                   Arrival& soonest) {
    constexpr int kMaxDepth = 3;
    const VehicleArrays& v = state.vehicles;
    if (here.depth == kMaxDepth) return;
    const Turn turn = model.graph.lanes[at(here.connection)].turn;
    const auto consider = [&](int slot, double distance_m, double limit_mps) {
        if (v.speed_mps[at(slot)] < kCrawlingSpeed_mps || distance_m > search.horizon_s * limit_mps) return;
        const VehicleRecord& record = v.record[at(slot)];
        // Only the first call (depth 0) checks the turn that the vehicle will make at the end of `here.lane`
        // (following_turn). The call ignores vehicles with another turn than that of `here.connection`, and vehicles
        // whose trip ends on `here.lane` (Turn::none). A vehicle without a trip can have Turn::none, too, because its
        // turn is not drawn yet. Such a vehicle is assumed to take `here.connection`.
        const bool unknown = record.following_turn == Turn::none && !v.itinerary_of(at(slot)).has_trip();
        if (here.depth == 0 && !unknown && record.following_turn != turn) return;
        soonest.keep_earlier(earliest_arrival_s(distance_m, v.speed_mps[at(slot)], search.acceleration_mps2, limit_mps),
                             slot);
    };
    for (const int upstream_connection : model.connections_to.of(here.lane)) {
        const LanePlan& connection = state.plan.lane(upstream_connection);
        if (here.to_area_m > search.horizon_s * connection.limit_mps) continue;
        const LaneBlock& block = state.blocks[at(upstream_connection)];
        const double limit_mps = state.plan.lane(here.lane).limit_mps;
        if (block.count > 0) {
            consider(block.first, here.to_area_m + connection.length_m - v.position_m[at(block.first)], limit_mps);
            continue;
        }
        const double from_m = here.to_area_m + connection.length_m + state.plan.lane(connection.origin).length_m;
        const LaneBlock& origin_block = state.blocks[at(connection.origin)];
        for (int slot = origin_block.first; slot < origin_block.past_last(); ++slot) {
            const double distance_m = from_m - v.position_m[at(slot)];
            if (distance_m > search.horizon_s * limit_mps) break;
            if (v.next_lane[at(slot)] == upstream_connection) {
                consider(slot, distance_m, limit_mps);
                break;
            }
        }
        look_upstream(model, state, {connection.origin, upstream_connection, from_m, here.depth + 1}, search, soonest);
    }
}

}  // namespace

Arrival next_arrival(const Model& model, const State& state, const Conflict& conflict, const ArrivalSearch& search) {
    const VehicleArrays& v = state.vehicles;
    const LanePlan& other = state.plan.lane(conflict.other);
    const LanePlan& origin = state.plan.lane(other.origin);
    const int stopping = vehicle_stopping_at_signal(state, other.origin, conflict.other);
    const int held = vehicle_held_at_rest(model, state, other.origin);
    const auto is_ignored = [&](int slot) {
        return search.ignores_crawling && v.speed_mps[at(slot)] < kCrawlingSpeed_mps;
    };
    Arrival soonest;
    for (const JunctionOccupant& occupant : occupants_of(state, conflict.other)) {
        if (occupant.front_m > conflict.other_from_m) continue;  // in the area, see blocks_area()
        const bool yields = is_yielding_before(state, occupant.slot, conflict.other_from_m);
        if ((yields && lets_others_go(state, occupant.slot)) || occupant.slot == stopping ||
            is_ignored(occupant.slot) || is_behind_yielding_vehicle(state, conflict.other, occupant)) {
            return soonest;
        }
        const double distance_m = conflict.other_from_m - occupant.front_m;
        const double in_s =
            earliest_arrival_s(distance_m, v.speed_mps[at(occupant.slot)], search.acceleration_mps2, other.limit_mps);
        soonest.keep_earlier(in_s, occupant.slot);
    }
    const LaneBlock& block = state.blocks[at(other.origin)];
    if (block.count > 0 && (is_blocked_by_leader(state, block.first) || lets_others_go(state, block.first)))
        return soonest;
    for (int slot = block.first; slot < block.past_last(); ++slot) {
        const double distance_m = origin.length_m + conflict.other_from_m - v.position_m[at(slot)];
        if (distance_m > search.horizon_s * origin.limit_mps) break;
        if (slot == stopping) break;
        if (slot == held) return soonest;
        if (v.position_m[at(slot)] > origin.stop_line_m || v.next_lane[at(slot)] != conflict.other) continue;
        if (is_ignored(slot)) break;
        soonest.keep_earlier(
            earliest_arrival_s(distance_m, v.speed_mps[at(slot)], search.acceleration_mps2, other.limit_mps), slot);
        return soonest;
    }
    look_upstream(model, state, {other.origin, conflict.other, origin.length_m + conflict.other_from_m, 0}, search,
                  soonest);
    return soonest;
}

}  // namespace stopline
