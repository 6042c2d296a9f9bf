// Decides which vehicle stops at each stop line, for its signal or under the keep-clear rule.
#include "sim/junction/stop_lines.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/containers/index.h"
#include "base/simd/arithmetic.h"
#include "base/speed_thresholds.h"
#include "sim/junction/arrivals.h"
#include "sim/performance/prefetch.h"
#include "sim/state/delay_log.h"
#include "sim/state/queries/lane_end.h"
#include "sim/state/queries/stopping_distance.h"

namespace stopline {

namespace {

// Returns true if the vehicle can stop before the line if it brakes with `deceleration_mps2` after a response time.
bool can_stop(const Model& model, const VehicleArrays& v, int slot, double line_m, double deceleration_mps2) {
    return can_stop_after_response(model, v, slot, line_m - v.position_m[at(slot)], deceleration_mps2);
}

// Returns the highest deceleration with which a driver stops for a signal. On yellow this is the setting
// `stop.decision_deceleration`, on any other light the maximum braking.
double stopping_deceleration_mps2(const DriverTables& driver, Light light) {
    return light == Light::yellow ? driver.stop.decision_deceleration_mps2 : driver.cacc.deceleration_emergency_mps2;
}

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

// Returns the slot of the vehicle with this id on a lane; -1: none.
int slot_of(const VehicleArrays& v, const LaneBlock& block, int id) {
    for (int slot = block.first; slot < block.past_last(); ++slot) {
        if (v.id[at(slot)] == id) return slot;
    }
    return -1;
}

// Returns the slot of the first vehicle that can stop before the line for a signal that shows `light`; -1: none.
// Ignores vehicles whose trip ends on this lane.
int choose_stopper(const Model& model, const State& state, const LaneBlock& block, double line_m, Light light) {
    for (int slot = block.first; slot < block.past_last(); ++slot) {
        if (is_on_last_edge(state, slot)) continue;
        const DriverTables& driver = model.driver_of(state.vehicles.policy[at(slot)]).tables;
        if (can_stop(model, state.vehicles, slot, line_m, stopping_deceleration_mps2(driver, light))) return slot;
    }
    return -1;
}

// Returns the reaction time of the vehicle that stopped for the signal of a lane, in ticks. If the drivers differ and
// the vehicle has left the lane, returns 0.
std::int64_t hesitation_ticks(const Model& model, const State& state, const LaneBlock& block,
                              const StopLineState& line) {
    if (model.drivers.size() == 1) return model.drivers.front().hesitation_ticks;
    const int slot = slot_of(state.vehicles, block, line.stopping_vehicle);
    return slot < 0 ? 0 : model.driver_of(state.vehicles.policy[at(slot)]).hesitation_ticks;
}

// Returns true if the signal is green and no vehicle that stopped for it still hesitates to start.
bool line_is_open(const Model& model, const State& state, const LaneBlock& block, int signal_group,
                  const StopLineState& line) {
    if (state.signals.lights[at(signal_group)] != Light::green) return false;
    return line.stopping_vehicle < 0 ||
           state.tick >= state.signals.since_tick[at(signal_group)] + hesitation_ticks(model, state, block, line);
}

double space_needed_m(const VehicleArrays& v, int slot) {
    return static_cast<double>(v.length_m[at(slot)]) + static_cast<double>(v.standstill_gap_m[at(slot)]);
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
        if (is_stopping || can_stop(model, v, slot, line_m, stopping_deceleration_mps2(driver.tables, light)))
            return slot;
    }
    return -1;
}

// Returns true if the setting `count_queue_at_red_exit` is on and the lane ends at a signal that is not green for the
// lane's last vehicle. If no vehicle on the lane is stopped, the keep-clear rule then counts the moving vehicles
// upstream of the stop line as a queue at this line.
bool queue_ends_at_red(const Model& model, const State& state, int lane) {
    const LanePlan& plan = state.plan.lane(lane);
    if (!model.rules.count_queue_at_red_exit || plan.signal_group < 0) return false;
    const int next = plan.has_movement_signals ? state.vehicles.next_lane[at(state.blocks[at(lane)].last())] : -1;
    return state.signals.lights[at(state.plan.signal_group_for(lane, next))] != Light::green;
}

// Returns true if a vehicle on the lane is slower than kCrawlingSpeed_mps.
bool has_slow_vehicle(const State& state, const LaneBlock& block) {
    const std::span<const double> speeds_mps(state.vehicles.speed_mps.data(), at(state.vehicles.slots));
    bool found = false;
    for (const double mps : speeds_mps.subspan(at(block.first), at(block.count))) found |= mps < kCrawlingSpeed_mps;
    return found;
}

// Returns the free room in an exit lane. The first call in a step computes the room, and later calls in the same step
// reuse it.
const ExitRoom& exit_room(const Model& model, State& state, int exit) {
    const VehicleArrays& v = state.vehicles;
    ExitRoom& room = state.stop_lines.exit_rooms[at(exit)];
    if (room.tick == state.tick) return room;
    room = {state.tick, 1e9, -1};
    const LaneBlock& block = state.blocks[at(exit)];
    if (block.count == 0) return room;
    // next_limit_m: position of the stop line of the exit lane, or of the lane's end if there is no stop line.
    const double line_m = state.plan.lane(exit).next_limit_m;
    const bool ends_at_red = line_m <= model.rules.sight_m && queue_ends_at_red(model, state, exit);
    if (!ends_at_red && !has_slow_vehicle(state, block)) return room;
    double moving_m = 0.0;   // space that the moving vehicles will occupy after they have stopped
    double leaving_m = 0.0;  // part of moving_m that belongs to vehicles past the stop line
    for (int slot = block.last(); slot >= block.first; --slot) {
        const double rear_m = v.position_m[at(slot)] - static_cast<double>(v.length_m[at(slot)]);
        if (rear_m > model.rules.sight_m) return room;
        if (v.speed_mps[at(slot)] < kCrawlingSpeed_mps) {
            room.stopped_slot = slot;
            room.room_m = rear_m - moving_m;
            break;
        }
        moving_m += space_needed_m(v, slot);
        if (v.position_m[at(slot)] > line_m) leaving_m += space_needed_m(v, slot);
    }
    if (room.stopped_slot < 0 && ends_at_red) {
        room.stopped_slot = block.last();
        const int policy = v.policy[at(block.first)];
        room.room_m = line_m - model.driver_of(policy).tables.stop.margin_m - (moving_m - leaving_m);
    }
    if (room.stopped_slot < 0) return room;
    for (const int other : model.connections_to[at(exit)]) {
        const LaneBlock& inner = state.blocks[at(other)];
        for (int slot = inner.first; slot < inner.past_last(); ++slot) room.room_m -= space_needed_m(v, slot);
    }
    return room;
}

// Returns true if the vehicle in `slot` is on the approach lane `lane` and stops at its line by the latest decision for
// this lane. This is the decision of the present step if the lane comes earlier in the order of lanes, and otherwise
// that of an earlier step. Slots may have changed since then, so the vehicle is identified by its id.
bool stops_at_line(const State& state, int lane, int slot) {
    const LaneBlock& block = state.blocks[at(lane)];
    return slot >= block.first && slot < block.past_last() &&
           state.vehicles.id[at(slot)] == state.stop_lines.lines[at(lane)].stop_id;
}

// Returns true if `occupant`, a vehicle on connection `conflict.other`, must leave the conflict area before vehicles of
// the conflicting connection may start. This is the case if the occupant is in the area. It is also the case if the
// occupant is still before the area, its own signal is red, and the occupant does not stop at its stop line: it has
// then waited inside the intersection since an earlier green, or it passes the stop line at red.
bool must_clear_first(const State& state, const Conflict& conflict, const JunctionOccupant& occupant) {
    if (occupant.rear_m >= conflict.other_to_m) return false;
    if (occupant.front_m > conflict.other_from_m) return true;
    const int origin = state.plan.lane(conflict.other).origin;
    const int group = state.plan.signal_group_for(origin, conflict.other);
    return state.signals.lights[at(group)] == Light::red && !stops_at_line(state, origin, occupant.slot);
}

// Returns the slot of a stopped vehicle from a crossing street that must clear `connection` first; -1: none. Ignores
// connections that yield to `connection` or have priority over it, and vehicles that may be passed under the
// pass-blocker rule.
int crossing_blocker(const Model& model, const State& state, int connection) {
    if (!state.junctions.with_stopped.has_any(state.plan.conflicting(connection))) return -1;
    const VehicleArrays& v = state.vehicles;
    const std::int64_t pass_after_ticks = model.rules.pass_blocker_ticks;
    for (const Conflict& c : state.plan.conflicts(connection)) {
        if (c.yields || c.other_yields) continue;
        for (const JunctionOccupant& occupant : state.junctions.occupants[at(c.other)]) {
            if (v.speed_mps[at(occupant.slot)] >= kCrawlingSpeed_mps || !must_clear_first(state, c, occupant)) continue;
            if (pass_after_ticks > 0 && state.tick - v.stopped_since[at(occupant.slot)] >= pass_after_ticks) continue;
            return occupant.slot;
        }
    }
    return -1;
}

// Data of one connection for the keep-clear rule.
struct ConnectionState {
    int connection;
    int stopped_in_exit;  // slot of a stopped vehicle in the exit lane (ExitRoom::stopped_slot)
    int crossing_slot;    // slot of the vehicle that crossing_blocker() found; -1: none
    double room_m;        // free room in the exit lane minus the space for the vehicles already checked
    bool is_free;  // true: nothing blocks the connection, and all vehicles of the approach lane fit into the exit
};

// The ConnectionState of each connection that vehicles of one approach lane take. A state is computed when it is first
// used.
class ConnectionStates {
public:
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): states_ is written before it is read
    ConnectionStates(const Model& model, State& state, int vehicles)
        : model_(model), state_(state), ample_room_m_(vehicles * state.plan.max_space_per_vehicle_m() + kRounding_m) {}

    // Returns nullptr if the keep-clear rule does not apply to the connection, or if all elements of states_ are in
    // use.
    ConnectionState* state_of(int connection) {
        if (last_ != nullptr && last_->connection == connection) return last_;
        return last_ = find(connection);
    }

private:
    ConnectionState* find(int connection) {
        for (std::size_t k = 0; k < count_; ++k) {
            if (states_[k].connection == connection) return &states_[k];
        }
        if (connection < 0 || count_ == states_.size()) return nullptr;
        const LanePlan& plan = state_.plan.lane(connection);
        if (plan.exit < 0 || !plan.keep_clear) return nullptr;
        const ExitRoom& room = exit_room(model_, state_, plan.exit);
        const int crossing_slot = crossing_blocker(model_, state_, connection);
        states_[count_] = {connection, room.stopped_slot, crossing_slot, room.room_m,
                           crossing_slot < 0 && room.room_m >= ample_room_m_};
        return &states_[count_++];
    }

    static constexpr double kRounding_m = 1e-3;

    const Model& model_;
    State& state_;
    double ample_room_m_;                     // room that suffices for all vehicles of the approach lane
    std::array<ConnectionState, 16> states_;  // not initialised, to save time in every step
    std::size_t count_ = 0;
    // Result of the previous call of state_of(). Most vehicles take the same connection as their leader.
    ConnectionState* last_ = nullptr;
};

// Returns true if the vehicle can still stop before the line for the keep-clear rule. It may brake with the peak
// deceleration of a normal stop, or with the comfortable deceleration if this is higher. The peak is kLagFactor times
// `stop.deceleration`, but at most the emergency deceleration: with brake lag, braking starts late and must then be
// harder. The mesoscale mode has no brake lag, so no response time is added there to braking with the peak.
bool can_hold_for_keep_clear(const Model& model, const VehicleArrays& v, int slot, double line_m) {
    constexpr double kLagFactor = 1.4;  // ratio of the highest deceleration of a normal stop to `stop.deceleration`
    const DriverTables& driver = model.driver_of(v.policy[at(slot)]).tables;
    const CaccSettings& cacc = driver.cacc;
    const double peak_mps2 = std::min(kLagFactor * driver.stop.deceleration_mps2, cacc.deceleration_emergency_mps2);
    if (peak_mps2 <= cacc.deceleration_comfort_mps2) {
        return can_stop(model, v, slot, line_m, cacc.deceleration_comfort_mps2);
    }
    if (!model.meso) return can_stop(model, v, slot, line_m, peak_mps2);
    return square(v.speed_mps[at(slot)]) <= 2.0 * peak_mps2 * (line_m - v.position_m[at(slot)]);
}

// Returns the slot of the first vehicle that the keep-clear rule holds before the line; -1: none. Stores the reason in
// StopLines::held_at_green: the exit lane has no room, or a stopped vehicle blocks the connection.
int choose_keep_clear_stop(const Model& model, State& state, int index) {
    constexpr double kDecisionDistance_m = 80.0;  // vehicles further upstream of the line are not held
    const VehicleArrays& v = state.vehicles;
    const double line_m = state.plan.lane(index).stop_line_m;
    const LaneBlock& block = state.blocks[at(index)];
    ConnectionStates connections(model, state, block.count);
    for (int slot = block.first; slot < block.past_last(); ++slot) {
        if (v.position_m[at(slot)] < line_m - kDecisionDistance_m) break;
        ConnectionState* const next = connections.state_of(v.next_lane[at(slot)]);
        if (next == nullptr || next->is_free) continue;
        next->room_m -= space_needed_m(v, slot);
        if ((next->room_m >= 0.0 && next->crossing_slot < 0) || v.position_m[at(slot)] > line_m) continue;
        if (!can_hold_for_keep_clear(model, v, slot, line_m)) continue;
        state.stop_lines.held_at_green[at(index)] = next->crossing_slot >= 0
                                                        ? KeepClearHold{next->crossing_slot, false}
                                                        : KeepClearHold{next->stopped_in_exit, true};
        return slot;
    }
    return -1;
}

// Records the use of the keep-clear rule when the rule begins to hold a vehicle. `slot`: the vehicle held in this step;
// -1: none.
void record_keep_clear_use(const Model& model, const State& state, Partition& part, int index, int slot,
                           StopLineState& line) {
    const VehicleArrays& v = state.vehicles;
    const int id = slot < 0 ? -1 : v.id[at(slot)];
    if (id >= 0 && id != line.keep_clear_vehicle && model.rules.watches()) {
        const int blocker = state.stop_lines.held_at_green[at(index)].blocker;
        const std::int64_t stood = blocker < 0 ? 0 : state.tick - v.stopped_since[at(blocker)];
        part.rule_uses.push_back({RuleUse::Kind::keep_clear, model.time_s(state.tick), id, index,
                                  blocker < 0 ? -1 : v.id[at(blocker)], model.time_s(stood)});
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

// Lists the vehicles of an approach lane for which right of way must be decided (JunctionState::approaching). Leaves
// out the vehicle that stops at the line and all vehicles behind it. Also leaves out vehicles that are further than
// decision_distance_m() from their first conflict area, or from the stop line if they may wait only there or have a
// stop sign. Exception: vehicles that must yield and have already accepted a gap are listed at a greater distance, too.
void list_approaching(const Model& model, State& state, int index) {
    // Vehicles further than this from the lane's end are not listed. 60 m suffice for a comfortable stop from 50 km/h.
    constexpr double kLookBack_m = 60.0;
    // Replaces kLookBack_m in imported networks (only their demand has trips), where speed limits above 50 km/h occur.
    constexpr double kFastRoadLookBack_m = 160.0;
    const bool has_trips = !model.demand.trips.empty();
    const double look_back_m = has_trips ? kFastRoadLookBack_m : kLookBack_m;
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
        if (!has_trips && !connection_plan.yields && !state.junctions.occupied.has_any(state.plan.conflicting(next)))
            continue;
        const DriverPlan& driver = model.driver_of(v.policy[at(slot)]);
        double to_area_m = to_end_m + connection_plan.first_conflict_m - driver.give_way.margin_m;
        if (!state.plan.may_wait_inside(next) || state.plan.stop_rule(next) != StopRule::none) {
            const double line_m = state.plan.lane(index).stop_line_m - driver.tables.stop.margin_m;
            to_area_m = std::min(to_area_m, line_m - v.position_m[at(slot)]);
        }
        const bool is_far = to_area_m > decision_distance_m(driver, v.speed_mps[at(slot)]);
        if (is_far && !(connection_plan.yields && v.record[at(slot)].accepted_gap_on == next)) continue;
        state.junctions.approaching[at(next)].push_back(slot);
        if (!state.junctions.to_decide.has(at(connection_plan.bitset_index))) state.plan.prefetch_conflicts(next);
        state.junctions.to_decide.set(at(connection_plan.bitset_index));
    }
}

}  // namespace

void decide_stop_lines(const Model& model, State& state, Partition& part) {
    for (const int index : part.awake_approaches) {
        advance_prefetch(state, part.prefetch);
        const LanePlan& lane = state.plan.lane(index);
        state.stop_lines.held_at_green[at(index)] = {};
        StopLineState& line = state.stop_lines.lines[at(index)];
        const LaneBlock& block = state.blocks[at(index)];
        int stop_slot = -1;
        int held_slot = -1;
        if (lane.has_movement_signals) {
            stop_slot = choose_stopper_per_movement(model, state, index, line);
            set_stopper(model, state, index, stop_slot, line);
            if (stop_slot >= 0) {
                make_platoon_leader(state, lane, stop_slot);
            } else if (model.rules.keep_clear) {
                stop_slot = held_slot = choose_keep_clear_stop(model, state, index);
            }
        } else if (line_is_open(model, state, block, lane.signal_group, line)) {
            line.stopping_vehicle = -1;
            if (model.rules.keep_clear) stop_slot = held_slot = choose_keep_clear_stop(model, state, index);
        } else {
            if (line.stopping_vehicle >= 0) stop_slot = slot_of(state.vehicles, block, line.stopping_vehicle);
            if (stop_slot < 0) {
                stop_slot =
                    choose_stopper(model, state, block, lane.stop_line_m, state.signals.lights[at(lane.signal_group)]);
            }
            set_stopper(model, state, index, stop_slot, line);
            if (stop_slot >= 0) make_platoon_leader(state, lane, stop_slot);
        }
        if (held_slot >= 0 || line.keep_clear_vehicle >= 0)
            record_keep_clear_use(model, state, part, index, held_slot, line);
        state.stop_lines.stop_slot[at(index)] = stop_slot;
        line.stop_id = stop_slot < 0 ? -1 : state.vehicles.id[at(stop_slot)];
        list_approaching(model, state, index);
    }
}

}  // namespace stopline
