// Decides which vehicle stops at each stop line, for its signal or under the keep-clear rule.
#include "sim/junction/stop_lines.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/containers/index.h"
#include "base/simd/arithmetic.h"
#include "base/speed_thresholds.h"
#include "sim/clearing/cooperative_clearing.h"
#include "sim/clearing/keep_clear.h"
#include "sim/performance/prefetch.h"
#include "sim/state/delay_log.h"
#include "sim/state/queries/lane_end.h"
#include "sim/state/queries/stopping_distance.h"
#include "sim/state/queries/vehicle_place.h"

namespace stopline {

double stopping_deceleration_mps2(const DriverTables& driver, Light light) {
    return light == Light::yellow ? driver.stop.decision_deceleration_mps2 : driver.cacc.deceleration_emergency_mps2;
}

bool can_stop_for_signal(const Model& model, const VehicleArrays& v, int slot, double line_m, Light light) {
    if (model.meso && model.is_imported() && light == Light::red)
        return can_stop_within(model, v.speed_mps[at(slot)], line_m - v.position_m[at(slot)]);
    const DriverTables& driver = model.driver_of(v.policy[at(slot)]).tables;
    return can_stop(model, v, slot, line_m, stopping_deceleration_mps2(driver, light));
}

namespace {

// Returns true if a stop needs more than 90 % of the maximum braking. The vehicle may then overrun the line: changes to
// a lower gear can reduce the braking by up to a tenth, and can_stop() ignores these gear changes. Returns false in the
// mesoscale mode, which has no gears.
bool may_overrun_line(const Model& model, const VehicleArrays& v, int slot, double line_m, Light light) {
    constexpr double kReliableShare = 0.9;
    const DriverTables& driver = model.driver_of(v.policy[at(slot)]).tables;
    const double reliable_mps2 = kReliableShare * driver.cacc.deceleration_emergency_mps2;
    if (model.meso || stopping_deceleration_mps2(driver, light) <= reliable_mps2) return false;
    return !can_stop(model, v, slot, line_m, reliable_mps2);
}

// Returns the slot of the first vehicle that can stop before the line for a signal that shows `light`; -1: none.
// Ignores vehicles whose trip ends on this lane. `chosen`: slot of the vehicle that stops already; -1: none. A vehicle
// ahead of it was too fast to stop. It stops instead if it has slowed for another reason before it reaches the line.
int choose_stopper(const Model& model, const State& state, const LaneBlock& block, double line_m, Light light,
                   int chosen) {
    if (light == Light::green && chosen >= 0) return chosen;  // the chosen vehicle still hesitates to start
    for (int slot = block.first; slot < block.past_last(); ++slot) {
        if (slot == chosen) return slot;
        if (is_on_last_edge(state, slot)) continue;
        if (can_stop_for_signal(model, state.vehicles, slot, line_m, light)) return slot;
    }
    return -1;
}

// Returns the reaction time of the vehicle that stopped for the signal of a lane, in ticks. If the drivers differ and
// the vehicle has left the lane, returns 0.
std::int64_t hesitation_ticks(const Model& model, const State& state, int index, const StopLineState& line) {
    if (model.drivers.size() == 1) return model.drivers.front().hesitation_ticks;
    const int slot = slot_on_lane(state, index, line.stopping_vehicle);
    return slot < 0 ? 0 : model.driver_of(state.vehicles.policy[at(slot)]).hesitation_ticks;
}

// Returns true if the signal is green and no vehicle that stopped for it still hesitates to start.
bool line_is_open(const Model& model, const State& state, int index, int signal_group, const StopLineState& line) {
    if (state.signals.lights[at(signal_group)] != Light::green) return false;
    return line.stopping_vehicle < 0 ||
           state.tick >= state.signals.since_tick[at(signal_group)] + hesitation_ticks(model, state, index, line);
}

// Returns the slot of the first vehicle that must stop for the signal of its own movement and can stop; -1: none. This
// may be a vehicle that still hesitates at the start of green. Used for lanes whose movements have separate signals.
int choose_stopper_per_movement(const Model& model, const State& state, int index, const StopLineState& line) {
    const LaneBlock& block = state.blocks[at(index)];
    const VehicleArrays& v = state.vehicles;
    for (int slot = block.first; slot < block.past_last(); ++slot) {
        if (is_on_last_edge(state, slot)) continue;
        const int group = state.plan.signal_group_for(index, v.next_lane[at(slot)]);
        const Light light = state.signals.lights[at(group)];
        const bool is_stopping = line.stopping_vehicle == v.id[at(slot)];
        const DriverPlan& driver = model.driver_of(v.policy[at(slot)]);
        const bool hesitates =
            is_stopping && state.tick < state.signals.since_tick[at(group)] + driver.hesitation_ticks;
        if (light == Light::green && !hesitates) continue;
        const double line_m = state.plan.lane(index).stop_line_m;
        if (is_stopping || can_stop_for_signal(model, v, slot, line_m, light)) return slot;
    }
    return -1;
}

// Records when the keep-clear rule or cooperative clearing begins to hold a vehicle, and the time for which a refused
// vehicle is stopped. `slot`: the vehicle held in this step; -1: none.
void record_hold(const Model& model, const State& state, Partition& part, int index, int slot, StopLineState& line) {
    const VehicleArrays& v = state.vehicles;
    const int id = slot < 0 ? -1 : v.id[at(slot)];
    const KeepClearHold& hold = state.stop_lines.held_at_green[at(index)];
    const bool is_new = id >= 0 && id != line.keep_clear_vehicle;
    if (id >= 0 && hold.is_refusal) {
        part.refused += is_new ? 1 : 0;
        part.refusal_ticks += v.speed_mps[at(slot)] < kStoppedSpeed_mps ? 1 : 0;
    }
    if (is_new && model.rules.watches()) {
        const int blocker = hold.blocker;
        const std::int64_t stopped_ticks = blocker < 0 ? 0 : state.tick - v.stopped_since_tick[at(blocker)];
        part.rule_uses.push_back({hold.is_refusal ? RuleUse::Kind::refused : RuleUse::Kind::keep_clear,
                                  model.time_s(state.tick), id, index, blocker < 0 ? -1 : v.id[at(blocker)],
                                  model.time_s(stopped_ticks)});
    }
    line.keep_clear_vehicle = id;
}

// Stores which vehicle stops at the line for its signal, and whether it may overrun the line. `slot` -1: no vehicle
// stops.
void set_stopper(const Model& model, const State& state, int index, int slot, StopLineState& line) {
    const VehicleArrays& v = state.vehicles;
    const int id = slot < 0 ? -1 : v.id[at(slot)];
    if (id >= 0 && id != line.stopping_vehicle) {
        const Light light = state.signals.lights[at(state.plan.signal_group_for(index, v.next_lane[at(slot)]))];
        line.may_overrun = may_overrun_line(model, v, slot, state.plan.lane(index).stop_line_m, light);
    }
    line.stopping_vehicle = id;
}

// Marks the vehicle in `slot`, which stops for the signal, as the leader of the platoon that starts at the next green.
// If the vehicle has stopped past the line, its VehicleRecord::junction_entry_tick is set to the present tick in each
// step. The vehicle thus counts as entering the intersection only when the stop ends. If the vehicle is upstream of the
// line, its entry tick must not change: its rear may still be in the previous intersection, where another thread reads
// the tick.
void make_platoon_leader(State& state, const LanePlan& lane, int slot) {
    state.vehicles.is_platoon_leader[at(slot)] = 1.0F;
    if (state.vehicles.position_m[at(slot)] > lane.stop_line_m) {
        state.vehicles.record[at(slot)].junction_entry_tick = static_cast<int>(state.tick);
    }
}

// Lists the vehicles of an approach lane for which right of way must be decided (Partition::approaching). Leaves
// out the vehicle that stops at the line and all vehicles behind it. Also leaves out vehicles that are further than
// decision_distance_m() from their first conflict area, or from the stop line if they may wait only there or have a
// stop sign. Exception: vehicles that must yield and have already accepted a gap are listed at a greater distance, too.
void list_approaching(const Model& model, State& state, Partition& part, int index) {
    // Vehicles further than this from the lane's end are not listed. 60 m suffice for a comfortable stop from 50 km/h.
    constexpr double kLookBack_m = 60.0;
    // Replaces kLookBack_m in imported networks, where speed limits above 50 km/h occur.
    constexpr double kFastRoadLookBack_m = 160.0;
    const double look_back_m = model.is_imported() ? kFastRoadLookBack_m : kLookBack_m;
    const VehicleArrays& v = state.vehicles;
    const double length_m = state.plan.lane(index).length_m;
    const LaneBlock& block = state.blocks[at(index)];
    for (int slot = block.first; slot < block.past_last(); ++slot) {
        const double to_end_m = length_m - v.position_m[at(slot)];
        if (to_end_m > look_back_m || slot == state.stop_lines.stop_slot[at(index)]) break;
        const int next = v.next_lane[at(slot)];
        if (next < 0) continue;
        const LanePlan& connection_plan = state.plan.lane(next);
        if (connection_plan.origin != index || connection_plan.bitset_index < 0) continue;
        // A vehicle with priority needs no decision while no vehicle is on a conflicting connection. In imported
        // networks a vehicle with priority may still have to wait for a vehicle without priority that is too fast to
        // stop.
        if (!model.is_imported() && !connection_plan.yields &&
            !state.junctions.occupied.has_any(state.plan.conflicting(next)))
            continue;
        const DriverPlan& driver = model.driver_of(v.policy[at(slot)]);
        double to_area_m = to_end_m + connection_plan.first_conflict_m - driver.give_way.margin_m;
        if (!state.plan.may_wait_inside(next) || state.plan.stop_rule(next) != StopRule::none) {
            const double line_m = state.plan.lane(index).stop_line_m - driver.tables.stop.margin_m;
            to_area_m = std::min(to_area_m, line_m - v.position_m[at(slot)]);
        }
        const bool is_far = to_area_m > decision_distance_m(driver, v.speed_mps[at(slot)]);
        if (is_far && !(connection_plan.yields && v.record[at(slot)].accepted_gap_on == next)) continue;
        part.approaching.add(next, slot, state.junctions.approaching_place);
        if (!state.junctions.to_decide.has(at(connection_plan.bitset_index))) state.plan.prefetch_conflicts(next);
        state.junctions.to_decide.set(at(connection_plan.bitset_index));
    }
}

// Returns the slot of the vehicle that the keep-clear rule or cooperative clearing holds before the line; -1: none.
// `stop_slot`: slot of the vehicle that stops for its signal; -1: none. `may_go`: no vehicle must stop for the signal.
int choose_held_vehicle(const Model& model, State& state, int index, int stop_slot, bool may_go) {
    if (!model.rules.clearing) {
        return may_go && model.rules.keep_clear ? choose_keep_clear_stop(model, state, index) : -1;
    }
    const int refused = admit_vehicles(model, state, index, stop_slot);
    if (refused < 0) return -1;
    if (stop_slot >= 0 && refused > stop_slot) {
        state.stop_lines.held_at_green[at(index)] = {};
        return -1;
    }
    // The followers learn by V2V that the vehicle stops, and stop with it.
    if (state.stop_lines.held_at_green[at(index)].is_refusal)
        make_platoon_leader(state, state.plan.lane(index), refused);
    return refused;
}

}  // namespace

void decide_stop_lines(const Model& model, State& state, Partition& part) {
    if (model.rules.clearing) update_claims(model, state, part);
    for (const int index : part.awake_approaches) {
        advance_prefetch(state, part.prefetch);
        const LanePlan& lane = state.plan.lane(index);
        state.stop_lines.held_at_green[at(index)] = {};
        StopLineState& line = state.stop_lines.lines[at(index)];
        const LaneBlock& block = state.blocks[at(index)];
        int stop_slot = -1;
        bool may_go = true;  // true: no vehicle stops for its signal
        if (lane.has_movement_signals) {
            stop_slot = choose_stopper_per_movement(model, state, index, line);
            set_stopper(model, state, index, stop_slot, line);
            may_go = stop_slot < 0;
        } else if (line_is_open(model, state, index, lane.signal_group, line)) {
            line.stopping_vehicle = -1;
        } else {
            if (line.stopping_vehicle >= 0) stop_slot = slot_on_lane(state, index, line.stopping_vehicle);
            const Light light = state.signals.lights[at(lane.signal_group)];
            stop_slot = choose_stopper(model, state, block, lane.stop_line_m, light, stop_slot);
            set_stopper(model, state, index, stop_slot, line);
            may_go = false;
        }
        if (stop_slot >= 0) make_platoon_leader(state, lane, stop_slot);
        const int held_slot = choose_held_vehicle(model, state, index, stop_slot, may_go);
        if (held_slot >= 0) stop_slot = held_slot;
        if (held_slot >= 0 || line.keep_clear_vehicle >= 0) record_hold(model, state, part, index, held_slot, line);
        state.stop_lines.stop_slot[at(index)] = stop_slot;
        line.stop_id = stop_slot < 0 ? -1 : state.vehicles.id[at(stop_slot)];
        list_approaching(model, state, part, index);
    }
}

}  // namespace stopline
