#include "sim/clearing/keep_clear.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/simd/arithmetic.h"
#include "base/speed_thresholds.h"
#include "sim/clearing/short_exits.h"
#include "sim/state/queries/gap.h"
#include "sim/state/queries/stopping_distance.h"

namespace stopline {

bool can_stop(const Model& model, const VehicleArrays& v, int slot, double line_m, double deceleration_mps2) {
    return can_stop_after_response(model, v, slot, line_m - v.position_m[at(slot)], deceleration_mps2);
}

namespace {

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

}  // namespace

const ExitRoom& exit_room(const Model& model, State& state, int exit) {
    const VehicleArrays& v = state.vehicles;
    ExitRoom& room = state.stop_lines.exit_rooms[at(exit)];
    if (room.tick == state.tick) return room;
    room = {state.tick, kAmpleRoom_m, -1};
    const LaneBlock& block = state.blocks[at(exit)];
    if (block.count == 0) return room;
    // next_limit_m: position of the stop line of the exit lane, or of the lane's end if there is no stop line.
    const double line_m = state.plan.lane(exit).next_limit_m;
    const bool ends_at_red = line_m <= model.rules.sight_m && queue_ends_at_red(model, state, exit);
    if (!ends_at_red && !has_slow_vehicle(state, block)) return room;
    double moving_m = 0.0;   // space that the moving vehicles will occupy after they have stopped
    double leaving_m = 0.0;  // part of moving_m that belongs to vehicles past the stop line
    for (int slot = block.last(); slot >= block.first; --slot) {
        const double slot_rear_m = rear_m(v, slot);
        if (slot_rear_m > model.rules.sight_m) return room;
        if (v.speed_mps[at(slot)] < kCrawlingSpeed_mps) {
            room.stopped_slot = slot;
            room.room_m = slot_rear_m - moving_m;
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
    for (const int other : model.connections_to.of(exit)) {
        const LaneBlock& inner = state.blocks[at(other)];
        for (int slot = inner.first; slot < inner.past_last(); ++slot) room.room_m -= space_needed_m(v, slot);
    }
    return room;
}

namespace {

// Returns true if the vehicle in `slot` is on the approach lane `lane` and stops at its line by the latest decision for
// this lane. This is the decision of the present step if the lane comes earlier in the order of lanes, and otherwise
// that of an earlier step. Slots may have changed since then, so the vehicle is identified by its id.
bool stops_at_line(const State& state, int lane, int slot) {
    return state.blocks[at(lane)].has(slot) && state.vehicles.id[at(slot)] == state.stop_lines.lines[at(lane)].stop_id;
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

}  // namespace

int crossing_blocker(const Model& model, const State& state, int connection) {
    if (!state.junctions.with_stopped.has_any(state.plan.conflicting(connection))) return -1;
    const VehicleArrays& v = state.vehicles;
    const std::int64_t pass_after_ticks = model.rules.pass_blocker_ticks;
    for (const Conflict& c : state.plan.conflicts(connection)) {
        if (c.yields || c.other_yields) continue;
        for (const JunctionOccupant& occupant : occupants_of(state, c.other)) {
            if (v.speed_mps[at(occupant.slot)] >= kCrawlingSpeed_mps || !must_clear_first(state, c, occupant)) continue;
            if (pass_after_ticks > 0 && state.tick - v.stopped_since_tick[at(occupant.slot)] >= pass_after_ticks)
                continue;
            return occupant.slot;
        }
    }
    return -1;
}

namespace {

// Data of one connection for the keep-clear rule.
struct ConnectionState {
    int connection;
    int stopped_in_exit;  // slot of a stopped vehicle in the exit lane (ExitRoom::stopped_slot)
    int crossing_slot;    // slot of the vehicle that crossing_blocker() found; -1: none
    double room_m;        // free room in the exit lane minus the space for the vehicles already checked
    bool is_free;  // true: nothing blocks the connection, and all vehicles of the approach lane fit into the exit
    // True: the exit lane is short, and no queue limits its room (ExitRoom::stopped_slot is -1).
    bool has_short_exit;
    ShortExitCheck short_exit;  // used if has_short_exit is true

    KeepClearHold check(const Model& model, const State& state, int approach, int slot);
};

// Returns the reason why the vehicle in `slot` must not enter; KeepClearHold::blocker is -1 if it may enter. Call this
// in driving order for the vehicles of an approach lane, because each call reserves the space of its vehicle.
KeepClearHold ConnectionState::check(const Model& model, const State& state, int approach, int slot) {
    room_m -= space_needed_m(state.vehicles, slot);
    const int ahead_on_short_exit =
        has_short_exit ? short_exit.count_and_find_blocker(model, state, approach, slot) : -1;
    if (crossing_slot >= 0) return {crossing_slot, false};
    if (room_m < 0.0) return {stopped_in_exit, true};
    return {ahead_on_short_exit, true};
}

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
        const bool has_short_exit =
            state_.plan.has_short_exits() && room.stopped_slot < 0 && state_.plan.is_short(plan.exit);
        const bool is_free = crossing_slot < 0 && room.room_m >= ample_room_m_ && !has_short_exit;
        states_[count_] = {connection, room.stopped_slot, crossing_slot,   room.room_m,
                           is_free,    has_short_exit,    ShortExitCheck()};
        if (has_short_exit) states_[count_].short_exit = ShortExitCheck(model_, state_, plan.exit);
        return &states_[count_++];
    }

    static constexpr double kRounding_m = 1e-3;

    const Model& model_;
    State& state_;
    double ample_room_m_;                                  // room that suffices for all vehicles of the approach lane
    static constexpr std::size_t kMaxConnections = 16;     // our choice: the rule ignores further connections
    std::array<ConnectionState, kMaxConnections> states_;  // not initialised, to save time in every step
    std::size_t count_ = 0;
    // Result of the previous call of state_of(). Most vehicles take the same connection as their leader.
    ConnectionState* last_ = nullptr;
};

}  // namespace

bool can_hold_for_keep_clear(const Model& model, const State& state, int lane, int slot) {
    const VehicleArrays& v = state.vehicles;
    if (state.stop_lines.lines[at(lane)].keep_clear_vehicle == v.id[at(slot)]) return true;
    const double line_m = state.plan.lane(lane).stop_line_m;
    // Ratio of the peak deceleration of a normal stop to `stop.deceleration`. With brake lag, braking starts late and
    // must then be harder. Our choice.
    constexpr double kLagFactor = 1.4;
    const DriverTables& driver = model.driver_of(v.policy[at(slot)]).tables;
    const CaccSettings& cacc = driver.cacc;
    const double peak_mps2 = std::min(kLagFactor * driver.stop.deceleration_mps2, cacc.deceleration_emergency_mps2);
    if (peak_mps2 <= cacc.deceleration_comfort_mps2) {
        return can_stop(model, v, slot, line_m, cacc.deceleration_comfort_mps2);
    }
    if (!model.meso) return can_stop(model, v, slot, line_m, peak_mps2);
    return square(v.speed_mps[at(slot)]) <= 2.0 * peak_mps2 * (line_m - v.position_m[at(slot)]);
}

int choose_keep_clear_stop(const Model& model, State& state, int lane) {
    constexpr double kDecisionDistance_m = 80.0;  // our choice: vehicles further upstream of the line are not held
    const VehicleArrays& v = state.vehicles;
    const double line_m = state.plan.lane(lane).stop_line_m;
    const LaneBlock& block = state.blocks[at(lane)];
    ConnectionStates connections(model, state, block.count);
    for (int slot = block.first; slot < block.past_last(); ++slot) {
        if (v.position_m[at(slot)] < line_m - kDecisionDistance_m) break;
        ConnectionState* const next = connections.state_of(v.next_lane[at(slot)]);
        if (next == nullptr || next->is_free) continue;
        const KeepClearHold hold = next->check(model, state, lane, slot);
        if (hold.blocker < 0 || v.position_m[at(slot)] > line_m) continue;
        if (!can_hold_for_keep_clear(model, state, lane, slot)) continue;
        state.stop_lines.held_at_green[at(lane)] = hold;
        return slot;
    }
    return -1;
}

}  // namespace stopline
