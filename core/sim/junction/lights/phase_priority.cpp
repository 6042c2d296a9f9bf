#include "sim/junction/lights/phase_priority.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>

#include "base/containers/index.h"
#include "sim/state/queries/stopping_distance.h"

namespace stopline {

namespace {

// Marks vehicles on connection `lane` and its approach lane as having accepted a gap if they can no longer stop before
// the conflict area with connection `other`. The function is called when `lane` begins to yield to `other`. The marked
// vehicles thus still go first.
void keep_priority_of_unstoppable(const Model& model, State& state, int lane, int other) {
    VehicleArrays& v = state.vehicles;
    const int origin = state.plan.lane(lane).origin;
    for (const Conflict& conflict : state.plan.conflicts(lane)) {
        if (conflict.other != other) continue;
        const auto check = [&](int on_lane, double offset_m) {
            const LaneBlock& block = state.blocks[at(on_lane)];
            for (int slot = block.first; slot < block.past_last(); ++slot) {
                if (on_lane == origin && v.next_lane[at(slot)] != lane) continue;
                const DriverPlan& driver = model.driver_of(v.policy[at(slot)]);
                const double room_m = conflict.from_m - driver.give_way.margin_m - (v.position_m[at(slot)] + offset_m);
                if (reliable_stopping_distance_m(model, driver, v.speed_mps[at(slot)]) > room_m)
                    v.record[at(slot)].accepted_gap_on = lane;
            }
        };
        check(lane, 0.0);
        check(origin, -state.plan.lane(origin).length_m);
    }
}

// Returns the present right of way between two connections.
Priority present_priority(const State& state, int first, int second) {
    for (const Conflict& conflict : state.plan.conflicts(first)) {
        if (conflict.other == second) return {conflict.yields, conflict.other_yields};
    }
    return {};
}

void change_priority(const Model& model, State& state, int first, int second, Priority before, Priority now) {
    state.plan.set_priority(first, second, now);
    if (now.first_yields && !before.first_yields) keep_priority_of_unstoppable(model, state, first, second);
    if (now.second_yields && !before.second_yields) keep_priority_of_unstoppable(model, state, second, first);
}

// Sets the right of way of the phases that begin at the present tick.
void begin_phases(const Model& model, State& state) {
    if (state.signals.last_phase_start_tick != state.tick) return;
    for (const PriorityByPhase& changing : model.priorities_by_phase) {
        if (state.signals.phase_start_tick[at(changing.signal)] != state.tick) continue;
        const std::optional<Priority>& now = changing.by_phase[at(state.signals.phase[at(changing.signal)])];
        if (!now) continue;
        const Priority before = present_priority(state, changing.first, changing.second);
        if (*now != before) change_priority(model, state, changing.first, changing.second, before, *now);
    }
}

}  // namespace

void update_phase_priorities(const Model& model, State& state) {
    if (!model.priorities_by_phase.empty()) begin_phases(model, state);
    if (state.tick < state.junctions.next_priority_tick) return;
    std::int64_t next_tick = std::numeric_limits<std::int64_t>::max();
    for (const PhasePriority& changing : model.phase_priorities) {
        const Priority now = changing.at(state.tick);
        next_tick = std::min(next_tick, changing.next_change_tick(state.tick));
        const Priority before = changing.at(state.tick - 1);
        if (state.tick > 0 && now == before) continue;
        change_priority(model, state, changing.first(), changing.second(), before, now);
    }
    state.junctions.next_priority_tick = next_tick;
}

}  // namespace stopline
