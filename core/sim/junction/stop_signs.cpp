#include "sim/junction/stop_signs.h"

#include <algorithm>
#include <span>

#include "base/containers/index.h"
#include "base/speed_thresholds.h"

namespace stopline {

namespace {

// Returns the slot of the first vehicle upstream of the stop line before a connection, if this vehicle has stopped at
// the line and will take the connection; else -1. Also returns -1 if the keep-clear rule holds the vehicle.
int stopped_at_line(const State& state, int connection) {
    const int approach = state.plan.lane(connection).origin;
    const LaneBlock& block = state.blocks[at(approach)];
    const VehicleArrays& v = state.vehicles;
    for (int slot = block.first; slot < block.past_last(); ++slot) {
        if (v.position_m[at(slot)] > state.plan.lane(approach).stop_line_m) continue;
        const bool goes = v.next_lane[at(slot)] == connection && v.record[at(slot)].line_stop_tick >= 0 &&
                          slot != state.stop_lines.stop_slot[at(approach)];
        return goes ? slot : -1;
    }
    return -1;
}

// Returns true if the candidate, which will take connection `lane`, may go before a vehicle that stopped earlier and
// will take connection `next`. The condition is that a third vehicle has just started that conflicts with the earlier
// vehicle but not with the candidate. The candidate then goes together with the third vehicle. The candidate must have
// stopped (at tick `stop_tick`) before the third vehicle started. Otherwise ever new vehicles could go before the
// earlier vehicle.
bool may_accompany(const Model& model, const State& state, int lane, int next, int stop_tick) {
    constexpr double kJustStarted_s = 2.0;
    const auto has_conflict = [&](int connection) {
        const std::span<const Conflict> conflicts = state.plan.conflicts(lane);
        return connection == lane || std::any_of(conflicts.begin(), conflicts.end(), [&](const Conflict& conflict) {
                   return conflict.other == connection;
               });
    };
    for (const Conflict& conflict : state.plan.conflicts(next)) {
        if (has_conflict(conflict.other)) continue;
        for (const JunctionOccupant& occupant : occupants_of(state, conflict.other)) {
            if (occupant.since_tick >= stop_tick && model.time_s(state.tick - occupant.since_tick) <= kJustStarted_s)
                return true;
        }
    }
    return false;
}

}  // namespace

Wait stop_sign_wait(const Model& model, State& state, int lane, const Candidate& candidate, double line_m) {
    constexpr double kAtLine_m = 2.0;  // largest distance to line_m at which a stop counts as a stop at the line
    const StopRule rule = state.plan.stop_rule(lane);
    if (rule == StopRule::none || candidate.inside) return {};
    VehicleArrays& v = state.vehicles;
    VehicleRecord& record = v.record[at(candidate.slot)];
    if (record.line_stop_tick < 0) {
        const double speed_mps = v.speed_mps[at(candidate.slot)];
        if (speed_mps < kStoppedSpeed_mps && line_m - candidate.front_m < kAtLine_m) {
            record.line_stop_tick = static_cast<int>(state.tick);
        } else {
            return {line_m, -1, YieldReason::stop_sign};
        }
    }
    if (rule != StopRule::all_way_stop) return {};
    for (const Conflict& conflict : state.plan.conflicts(lane)) {
        if (state.plan.stop_rule(conflict.other) != StopRule::all_way_stop) continue;
        const int other = stopped_at_line(state, conflict.other);
        if (other < 0) continue;
        const int other_tick = v.record[at(other)].line_stop_tick;
        const bool was_earlier = other_tick < record.line_stop_tick ||
                                 (other_tick == record.line_stop_tick && v.id[at(other)] < v.id[at(candidate.slot)]);
        if (was_earlier && !may_accompany(model, state, lane, conflict.other, record.line_stop_tick))
            return {line_m, other, YieldReason::priority};
    }
    return {};
}

}  // namespace stopline
