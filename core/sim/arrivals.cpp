#include "sim/arrivals.h"

#include <algorithm>
#include <cmath>

#include "base/arithmetic.h"

namespace stopline {

namespace {

constexpr double kCloseBehind_m = 6.0;
constexpr double kSeen_m = 20.0;

std::size_t at(int index) { return static_cast<std::size_t>(index); }

}  // namespace

bool held(const State& state, int slot) {
    const VehicleArrays& v = state.vehicles;
    return v.record[at(slot)].held_at >= state.tick - 1 && v.speed_mps[at(slot)] < kAlmostStands_mps;
}

bool held_before(const State& state, int slot, double area_m) {
    return held(state, slot) && state.vehicles.record[at(slot)].held_m <= static_cast<float>(area_m);
}

double earliest_s(double distance_m, double speed_mps, double acceleration_mps2, double limit_mps) {
    const double to_limit_mps = std::max(limit_mps - speed_mps, 0.0);
    const double to_limit_m = to_limit_mps * (speed_mps + 0.5 * to_limit_mps) / acceleration_mps2;
    if (distance_m <= to_limit_m) {
        return (std::sqrt(square(speed_mps) + 2.0 * acceleration_mps2 * distance_m) - speed_mps) / acceleration_mps2;
    }
    return to_limit_mps / acceleration_mps2 + (distance_m - to_limit_m) / std::max(limit_mps, speed_mps);
}

bool blocked(const State& state, int slot) {
    const VehicleArrays& v = state.vehicles;
    const std::size_t i = at(slot);
    const double gap_m = v.position_m[i - 1] - v.length_m[i - 1] - v.position_m[i];
    return v.record[i].predecessor >= 0 && v.speed_mps[i] < kAlmostStands_mps &&
           v.speed_mps[i - 1] < kAlmostStands_mps && gap_m < kCloseBehind_m;
}

namespace {

// Whether a vehicle is at the same intersection as a lane: what is decided for others may be known in this step, or not yet.
bool is_decided_with(const State& state, int lane, int slot) {
    const VehicleRecord& record = state.vehicles.record[at(slot)];
    const int on = state.plan.route(record.route)[at(record.route_index)];
    return state.plan.intersection_of(on) == state.plan.intersection_of(lane);
}

}  // namespace

bool behind_held(const State& state, int lane, const Insider& w) {
    constexpr int kMost = 8;  // vehicles inside, one behind the other
    int slot = w.slot;
    int on = w.front_m > 0.0 ? lane : state.plan.lane(lane).origin;
    for (int k = 0; k < kMost && blocked(state, slot); ++k) {
        const LaneBlock& block = state.blocks[at(on)];
        if (slot == block.first) {
            slot = vehicle_ahead(state, on, slot, kSeen_m).slot;
            const LaneBlock& inside = state.blocks[at(lane)];
            const bool on_way = slot >= inside.first && slot < inside.stop();
            if (!on_way) return slot >= 0 && is_decided_with(state, lane, slot) && held(state, slot);
            on = lane;
        } else {
            --slot;
        }
        if (held(state, slot)) return true;
    }
    return false;
}

namespace {

// The vehicle that stops before a lane's line, for the light of the way that is asked for; -1: none. With green all may set out.
int stops_at_light(const State& state, int lane, int way) {
    const int stopping = state.stop_slot[at(lane)];
    if (state.lights[at(state.plan.light_before(lane, way))] != Light::green) return stopping;
    if (stopping < 0 || !state.plan.lane(lane).by_way) return -1;
    const int next = state.vehicles.next_lane[at(stopping)];
    return state.lights[at(state.plan.light_before(lane, next))] == Light::green ? -1 : stopping;
}

// Vehicles that move and come to `lane` to go on to `way`, from further back. What is decided for them in this step is not asked for.
struct Upstream {
    int lane;
    int way;
    double to_area_m;  // from the lane's start
    int depth;
};

void look_upstream(const Model& model, const State& state, const Upstream& here, double horizon_s, Arrival& soonest) {
    constexpr int kDeepest = 3;
    const VehicleArrays& v = state.vehicles;
    if (here.depth == kDeepest) return;
    const Turn turn = model.graph.lanes[at(here.way)].turn;
    const auto see = [&](int slot, double distance_m, double limit_mps) {
        if (v.speed_mps[at(slot)] < kAlmostStands_mps || distance_m > horizon_s * limit_mps) return;
        const VehicleRecord& record = v.record[at(slot)];
        // Who draws its turn on the approach may come; a trip without a turn after this one does not.
        const bool unknown = record.trip < 0 && record.turn_after == Turn::none;
        if (here.depth == 0 && !unknown && record.turn_after != turn) return;
        soonest.earlier(earliest_s(distance_m, v.speed_mps[at(slot)], model.give_way.approach_mps2, limit_mps), slot);
    };
    for (const int inside : model.leads_to[at(here.lane)]) {
        const LanePlan& way = state.plan.lane(inside);
        if (here.to_area_m > horizon_s * way.limit_mps) continue;
        const LaneBlock& block = state.blocks[at(inside)];
        const double limit_mps = state.plan.lane(here.lane).limit_mps;
        if (block.count > 0) {
            see(block.first, here.to_area_m + way.length_m - v.position_m[at(block.first)], limit_mps);
            continue;
        }
        const double from_m = here.to_area_m + way.length_m + state.plan.lane(way.origin).length_m;
        const LaneBlock& before = state.blocks[at(way.origin)];
        for (int slot = before.first; slot < before.stop(); ++slot) {
            const double distance_m = from_m - v.position_m[at(slot)];
            if (distance_m > horizon_s * limit_mps) break;
            if (v.next_lane[at(slot)] == inside) {
                see(slot, distance_m, limit_mps);
                break;
            }
        }
        look_upstream(model, state, {way.origin, inside, from_m, here.depth + 1}, horizon_s, soonest);
    }
}

}  // namespace

Arrival next_arrival(const Model& model, const State& state, const Conflict& conflict, double horizon_s) {
    const VehicleArrays& v = state.vehicles;
    const LanePlan& other = state.plan.lane(conflict.other);
    const LanePlan& origin = state.plan.lane(other.origin);
    const double a = model.give_way.approach_mps2;
    const int stopping = stops_at_light(state, other.origin, conflict.other);
    Arrival soonest;
    for (const Insider& w : state.insiders[at(conflict.other)]) {
        if (w.front_m >= conflict.other_from_m) continue;
        if (held_before(state, w.slot, conflict.other_from_m) || w.slot == stopping ||
            behind_held(state, conflict.other, w)) {
            return soonest;
        }
        const double distance_m = conflict.other_from_m - w.front_m;
        soonest.earlier(earliest_s(distance_m, v.speed_mps[at(w.slot)], a, other.limit_mps), w.slot);
    }
    const LaneBlock& block = state.blocks[at(other.origin)];
    if (block.count > 0 && (blocked(state, block.first) || held(state, block.first))) return soonest;
    for (int slot = block.first; slot < block.stop(); ++slot) {
        const double distance_m = origin.length_m + conflict.other_from_m - v.position_m[at(slot)];
        if (distance_m > horizon_s * origin.limit_mps) break;
        if (slot == stopping) break;
        if (v.position_m[at(slot)] > origin.stop_line_m || v.next_lane[at(slot)] != conflict.other) continue;
        soonest.earlier(earliest_s(distance_m, v.speed_mps[at(slot)], a, other.limit_mps), slot);
        return soonest;
    }
    look_upstream(model, state, {other.origin, conflict.other, origin.length_m + conflict.other_from_m, 0}, horizon_s,
                  soonest);
    return soonest;
}

}  // namespace stopline
