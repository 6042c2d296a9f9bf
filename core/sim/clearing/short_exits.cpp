#include "sim/clearing/short_exits.h"

#include <algorithm>

#include "base/containers/index.h"
#include "base/speed_thresholds.h"
#include "sim/clearing/keep_clear.h"
#include "sim/state/queries/gap.h"

namespace stopline {

namespace {

// Returns true if a vehicle with priority over `connection` is near: its rear is not past the conflict area, and at its
// speed limit it reaches the end of its approach lane within kNear_s.
bool has_priority_traffic(const State& state, int connection) {
    constexpr double kNear_s = 8.0;  // our choice: a usual critical gap, and the time to reach the conflict area
    const VehicleArrays& v = state.vehicles;
    for (const Conflict& conflict : state.plan.conflicts(connection)) {
        if (!conflict.yields) continue;
        const LaneBlock& inside = state.blocks[at(conflict.other)];
        for (int slot = inside.first; slot < inside.past_last(); ++slot) {
            if (rear_m(v, slot) < conflict.other_to_m) return true;
        }
        const int origin = state.plan.lane(conflict.other).origin;
        const LanePlan& approach = state.plan.lane(origin);
        const LaneBlock& upstream = state.blocks[at(origin)];
        for (int slot = upstream.first; slot < upstream.past_last(); ++slot) {
            if (approach.length_m - v.position_m[at(slot)] > kNear_s * approach.limit_mps) break;
            if (v.next_lane[at(slot)] == conflict.other) return true;
        }
    }
    return false;
}

// Returns true if a vehicle is on the exit lane or on a connection to it.
bool is_occupied(const Model& model, const State& state, int exit) {
    if (state.blocks[at(exit)].count > 0) return true;
    return std::ranges::any_of(model.connections_to.of(exit),
                               [&](int connection) { return state.blocks[at(connection)].count > 0; });
}

// Returns true if a vehicle that takes connection `next` from `lane` may have to stop before it: its signal is not
// green, it must yield and a vehicle with priority is near, or it can be held because another vehicle uses the short
// exit lane of `next`.
bool may_stop_before(const Model& model, const State& state, int lane, int next) {
    const LanePlan& plan = state.plan.lane(next);
    if (plan.yields && has_priority_traffic(state, next)) return true;
    if (plan.keep_clear && plan.exit >= 0 && state.plan.is_short(plan.exit) && is_occupied(model, state, plan.exit))
        return true;
    return state.plan.lane(lane).signal_group >= 0 &&
           state.signals.lights[at(state.plan.signal_group_for(lane, next))] != Light::green;
}

bool may_stop_at_end(const Model& model, const State& state, int lane) {
    return std::ranges::any_of(state.plan.next(lane),
                               [&](int next) { return may_stop_before(model, state, lane, next); });
}

}  // namespace

ShortExitCheck::ShortExitCheck(const Model& model, const State& state, int exit)
    : exit_(exit), needed_m_(0.0), last_slot_(-1) {
    const VehicleArrays& v = state.vehicles;
    const LaneBlock& on_exit = state.blocks[at(exit)];
    for (int slot = on_exit.first; slot < on_exit.past_last(); ++slot) {
        const bool has_passed = v.position_m[at(slot)] > state.plan.lane(exit).next_limit_m;
        const int next = v.next_lane[at(slot)];
        if (!has_passed && (next < 0 || may_stop_before(model, state, exit, next))) count(state, slot);
    }
    for (const int connection : model.connections_to.of(exit)) {
        const LaneBlock& inner = state.blocks[at(connection)];
        for (int slot = inner.first; slot < inner.past_last(); ++slot) count(state, slot);
    }
}

void ShortExitCheck::count(const State& state, int slot) {
    needed_m_ += space_needed_m(state.vehicles, slot);
    last_slot_ = slot;
}

int ShortExitCheck::count_and_find_blocker(const Model& model, const State& state, int approach, int slot) {
    const VehicleArrays& v = state.vehicles;
    const int ahead = last_slot_;
    count(state, slot);
    if (ahead < 0) return -1;
    if (state.blocks[at(approach)].has(ahead) && v.speed_mps[at(ahead)] < kCrawlingSpeed_mps) return -1;
    // The first vehicle of the queue stops at a margin before the line. The last one needs no gap behind it.
    const double margin_m = model.driver_of(v.policy[at(slot)]).tables.stop.margin_m;
    const double queue_m = margin_m + needed_m_ - static_cast<double>(v.standstill_gap_m[at(slot)]);
    const bool has_room = queue_m <= state.plan.lane(exit_).next_limit_m;
    return has_room || !may_stop_at_end(model, state, exit_) ? -1 : ahead;
}

}  // namespace stopline
