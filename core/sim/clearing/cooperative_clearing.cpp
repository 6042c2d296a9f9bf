#include "sim/clearing/cooperative_clearing.h"

#include <algorithm>
#include <limits>

#include "base/containers/index.h"
#include "base/speed_thresholds.h"
#include "sim/clearing/arrival_forecast.h"
#include "sim/clearing/exit_booking.h"
#include "sim/clearing/keep_clear.h"
#include "sim/state/queries/desired_gap.h"
#include "sim/state/queries/lane_end.h"
#include "sim/state/queries/stopping_distance.h"

namespace stopline {

namespace {

// A forecast arrival counts as sure if it precedes the end of green by this time.
constexpr double kGreenReserve_s = 1.0;
// The last stopped vehicle of the exit lane must start this time before the earliest arrival at its rear.
constexpr double kStartReserve_s = 1.0;
constexpr double kAnywhere_m = 1e9;  // place of rest without any vehicle at rest
constexpr double kRounding_m = 1e-3;

// Returns true if the vehicle is the one of its lane that was refused last, and was refused since the start of a green.
bool was_refused_since(const Model& model, const State& state, int lane, int slot, std::int64_t green_tick) {
    constexpr double kStart_s = 2.0;  // covers the reaction time of the first vehicle
    const Refusal& refusal = state.clearing.refusals[at(lane)];
    return refusal.vehicle == state.vehicles.id[at(slot)] &&
           refusal.tick <= green_tick + to_ticks(kStart_s, model.step_s);
}

class LaneAdmission {
public:
    LaneAdmission(const Model& model, State& state, int lane, int stopping_slot)
        : model_(model),
          state_(state),
          v_(state.vehicles),
          clearing_(state.clearing),
          plan_(state.plan.lane(lane)),
          block_(state.blocks[at(lane)]),
          lane_(lane),
          end_(admitted_end(state, lane)) {
        const bool has_green = stopping_slot < 0 || light_of(stopping_slot) == Light::green;
        bound_ = has_green ? block_.past_last() : stopping_slot;
    }

    // Returns the slot of the vehicle that is refused; -1: none.
    int run() {
        while (end_ > bound_) change_booking(--end_, -1.0);
        const int first_new = end_;
        if (state_.tick % clearing_.announcement_ticks == 0) {
            withdraw();
            announce();
        } else {
            if (stays_refused()) return refused_;
            while (end_ < bound_ && decides_now(end_) && admit(end_, true)) {
            }
        }
        const bool has_admitted = end_ > block_.first && !is_past_line(end_ - 1);
        clearing_.last_admitted[at(lane_)] = has_admitted ? v_.id[at(end_ - 1)] : -1;
        if (end_ > first_new) clearing_.latest_admissions[at(lane_)] = {v_.id[at(first_new)], state_.tick};
        return refused_;
    }

private:
    // Between two announcements, a refused vehicle is not tested again. Returns true if the first vehicle that is not
    // admitted is such a vehicle.
    bool stays_refused() {
        if (end_ >= bound_ || !is_held(end_) || light_of(end_) != Light::green) return false;
        const int connection = connection_of(end_);
        if (connection < 0 || !has_v2v(state_, end_)) return false;
        refused_ = end_;
        const bool is_keep_clear = clearing_.refusals[at(lane_)].is_keep_clear;
        state_.stop_lines.held_at_green[at(lane_)] = {last_on_exit(connection), true, !is_keep_clear};
        return true;
    }

    bool is_held(int slot) const { return state_.stop_lines.lines[at(lane_)].keep_clear_vehicle == v_.id[at(slot)]; }

    int group_of(int slot) const { return state_.plan.signal_group_for(lane_, v_.next_lane[at(slot)]); }
    Light light_of(int slot) const { return state_.signals.lights[at(group_of(slot))]; }
    double to_line_m(int slot) const { return plan_.stop_line_m - v_.position_m[at(slot)]; }
    bool is_past_line(int slot) const { return to_line_m(slot) < 0.0; }

    // Returns the connection that the vehicle takes; -1: none.
    int connection_of(int slot) const {
        const int next = v_.next_lane[at(slot)];
        return next >= 0 && state_.plan.lane(next).origin == lane_ ? next : -1;
    }

    bool books(int slot) const {
        const int connection = connection_of(slot);
        if (connection < 0) return false;
        return takes_bookings(state_, state_.plan.lane(connection).exit, static_cast<double>(v_.length_m[at(slot)]));
    }

    ExitBooking& booking_of(int slot) {
        return exit_booking(model_, state_, state_.plan.lane(connection_of(slot)).exit);
    }

    KnownRoom room_of(int slot) {
        const int connection = connection_of(slot);
        const LanePlan& path = state_.plan.lane(connection);
        const double to_exit_m = plan_.length_m - v_.position_m[at(slot)] + path.length_m;
        return known_room(model_, state_, {lane_, slot, path.exit, to_exit_m});
    }

    void change_booking(int slot, double sign) {
        if (!books(slot)) return;
        ExitBooking& booking = booking_of(slot);
        booking.room_m -= sign * space_needed_m(v_, slot);
        booking.present_room_m -= sign * space_needed_m(v_, slot);
        booking.booked_m += sign * space_needed_m(v_, slot);
    }

    // Ends the admission of vehicles for which there is no more room, if they can still stop. This happens if a vehicle
    // without V2V has taken a booked place, or if a vehicle leaves its lane later than announced.
    void withdraw() {
        while (end_ > block_.first && !is_past_line(end_ - 1) && books(end_ - 1)) {
            if (room_of(end_ - 1).room_m >= -static_cast<double>(v_.standstill_gap_m[at(end_ - 1)])) return;
            if (light_of(end_ - 1) != Light::green || !can_hold(end_ - 1)) return;
            change_booking(--end_, -1.0);
        }
    }

    bool can_hold(int slot) const { return can_hold_for_keep_clear(model_, state_, lane_, slot); }

    // Returns true if the vehicle is so near to the line that it must decide whether to stop.
    bool decides_now(int slot) const {
        return to_line_m(slot) <= decision_distance_m(model_.driver_of(v_.policy[at(slot)]), v_.speed_mps[at(slot)]);
    }

    // Admits the vehicle in `slot` if it may enter. A vehicle that may not enter, but must decide now (`decides`), is
    // admitted if it can no longer stop, and else refused. Returns true if the vehicle is admitted. `slot` must be
    // `end_`.
    bool admit(int slot, bool decides) {
        const bool passes = is_on_last_edge(state_, slot) || light_of(slot) != Light::green;
        if (!passes && !may_enter(slot) && (!decides || can_hold(slot))) {
            if (!decides) return false;
            refused_ = slot;
            if (clearing_.refusals[at(lane_)].vehicle != v_.id[at(slot)])
                clearing_.refusals[at(lane_)] = {v_.id[at(slot)], state_.tick, false};
            clearing_.refusals[at(lane_)].is_keep_clear = !hold_.is_refusal;
            state_.stop_lines.held_at_green[at(lane_)] = hold_;
            return false;
        }
        change_booking(slot, 1.0);
        ++end_;
        return true;
    }

    // Returns true if the vehicle may enter. If not, stores the reason.
    bool may_enter(int slot) {
        const int connection = connection_of(slot);
        if (connection < 0 || !state_.plan.lane(connection).keep_clear) return true;
        bool cooperates = has_v2v(state_, slot);
        KnownRoom room;
        const bool needs_place = cooperates && books(slot);
        if (needs_place) room = room_of(slot);
        if (!room.is_fresh) cooperates = false;
        if (needs_place && room.is_fresh ? !has_place(slot, room) : !has_visible_room(slot)) {
            hold_ = {last_on_exit(connection), true, cooperates};
            return false;
        }
        if (const int blocker = crossing_blocker(model_, state_, connection); blocker >= 0) {
            hold_ = {blocker, false, cooperates};
            return false;
        }
        if (cooperates && may_stop_inside(slot, connection)) {
            hold_ = {slot == block_.first ? -1 : slot - 1, false, true};
            return false;
        }
        return true;
    }

    int last_on_exit(int connection) const {
        const LaneBlock& exit = state_.blocks[at(state_.plan.lane(connection).exit)];
        return exit.count > 0 ? exit.last() : -1;
    }

    // Returns true if the exit lane has a place for the vehicle that it can reach without a stop in a conflict area.
    bool has_place(int slot, const KnownRoom& booking) const {
        const int connection = connection_of(slot);
        const double length_m = v_.length_m[at(slot)];
        if (booking.room_m - respected_claims_m(slot, connection) < length_m - kRounding_m) return false;
        if (booking.present_room_m >= length_m) return true;
        const double rest_m = plan_.length_m + state_.plan.lane(connection).length_m + booking.present_room_m;
        const double earliest_s = travel_time_s(rest_m - v_.position_m[at(slot)], v_.speed_mps[at(slot)],
                                                model_.driver_of(v_.policy[at(slot)]).tables.cacc.acceleration_max_mps2,
                                                state_.plan.free_speed_mps(lane_));
        return booking.start_s + kStartReserve_s <= earliest_s;
    }

    // Returns the length that the vehicle leaves to vehicles with claims. Turning vehicles respect urgent claims only.
    // A vehicle with an urgent claim takes the first free place itself. If it had to respect the urgent claims of other
    // streets, all of them would wait for each other.
    double respected_claims_m(int slot, int connection) const {
        if (was_refused(slot)) return 0.0;
        const int exit = state_.plan.lane(connection).exit;
        return clearing_.connections[at(connection)].turns ? clearing_.urgent_claims_m[at(exit)]
                                                           : clearing_.claims_m[at(exit)];
    }

    // Returns true if the vehicle was refused throughout the previous green.
    bool was_refused(int slot) const {
        const int group = group_of(slot);
        const std::int64_t cycle_ticks = model_.signals.plan_of(group).nominal_cycle_ticks;
        return was_refused_since(model_, state_, lane_, slot, state_.signals.since_tick[at(group)] - cycle_ticks);
    }

    // Returns true if the exit lane has room for the vehicle and for those ahead of it under the keep-clear rule.
    bool has_visible_room(int slot) {
        const int connection = connection_of(slot);
        const ExitRoom& room = exit_room(model_, state_, state_.plan.lane(connection).exit);
        double needed_m = 0.0;
        for (int k = block_.first; k <= slot; ++k) {
            if (v_.next_lane[at(k)] == connection) needed_m += space_needed_m(v_, k);
        }
        return room.room_m >= needed_m;
    }

    // Returns true if the vehicle would stop in a conflict area behind a vehicle of its lane that may yield past the
    // stop line.
    bool may_stop_inside(int slot, int connection) const {
        if (clearing_.connections[at(lane_)].last_yield_m < 0.0) return false;
        double rest_m = rest_past_line_m();
        for (int k = block_.first; k < slot; ++k) rest_m = rest_behind(k, rest_m);
        if (rest_m >= kAnywhere_m) return false;
        return rest_m > plan_.length_m + state_.plan.lane(connection).first_conflict_m;
    }

    // Returns where the first vehicle of this lane would rest behind vehicles on the connections that may still yield,
    // from the start of the lane; kAnywhere_m: there are none.
    double rest_past_line_m() const {
        double rest_m = kAnywhere_m;
        if (clearing_.connections[at(lane_)].last_yield_m < 0.0) return rest_m;
        for (const int connection : state_.plan.next(lane_)) {
            const ClearingConnection& c = clearing_.connections[at(connection)];
            const LaneBlock& inner = state_.blocks[at(connection)];
            for (int slot = inner.first; c.last_yield_m >= 0.0 && slot < inner.past_last(); ++slot) {
                const double front_m = v_.position_m[at(slot)];
                if (front_m > c.last_yield_m) continue;
                rest_m = std::min(rest_m, plan_.length_m + std::max(front_m, c.first_wait_m));
                rest_m -= space_needed_m(v_, slot);
            }
        }
        return rest_m;
    }

    // Returns where the vehicle behind `slot` would rest. `rest_m`: place of rest of the vehicle in `slot`.
    double rest_behind(int slot, double rest_m) const {
        const int connection = connection_of(slot);
        if (connection >= 0 && clearing_.connections[at(connection)].last_yield_m >= 0.0) {
            const double wait_m = plan_.length_m + clearing_.connections[at(connection)].first_wait_m;
            rest_m = std::min(rest_m, std::max(wait_m, v_.position_m[at(slot)]));
        }
        return rest_m < kAnywhere_m ? rest_m - space_needed_m(v_, slot) : rest_m;
    }

    // Makes the announcement of the lane. Walks from the first vehicle upstream, and admits vehicles that decide now or
    // that are sure to pass in the present green.
    void announce() {
        const double line_rest_m = plan_.stop_line_m - clearing_.line_margin_m;
        LaneAnnouncement own{state_.tick, -1, line_rest_m};
        const double rest_m = rest_past_line_m();
        bool all_leave = rest_m >= kAnywhere_m;
        own.rest_m = std::min(own.rest_m, rest_m);
        ArrivalForecast forecast(model_, state_, lane_);
        int green_group = -2;
        double green_s = 0.0;
        for (int slot = block_.first; slot < bound_; ++slot) {
            if (const int group = group_of(slot); group != green_group) {
                green_group = group;
                green_s = remaining_green_s(model_, state_, group);
            }
            const bool passes = is_past_line(slot) || light_of(slot) != Light::green;
            const bool is_sure = forecast.next_s(slot) <= green_s - kGreenReserve_s || passes;
            if (slot >= end_) {
                const bool decides = decides_now(slot);
                if (!decides && !(is_sure && all_leave)) break;
                if (!admit(slot, decides)) break;
            }
            all_leave = all_leave && is_sure && leaves(slot, passes);
            if (all_leave) own.last_leaver = v_.id[at(slot)];
        }
        const std::int64_t number = state_.tick / clearing_.announcement_ticks;
        clearing_.announcements[at(lane_)][static_cast<std::size_t>(number % 4)] = own;
    }

    // Returns true if an admitted vehicle is sure to leave the lane once it has reached the line. A vehicle that may
    // have to yield is not. A vehicle without V2V is assumed to leave while it moves.
    bool leaves(int slot, bool passes) const {
        const int connection = connection_of(slot);
        if (connection < 0) return is_on_last_edge(state_, slot);
        if (clearing_.connections[at(connection)].last_yield_m >= 0.0) return false;
        return passes || has_v2v(state_, slot) || v_.speed_mps[at(slot)] >= kCrawlingSpeed_mps;
    }

    const Model& model_;
    State& state_;
    const VehicleArrays& v_;
    ClearingState& clearing_;
    const LanePlan& plan_;
    const LaneBlock& block_;
    int lane_;
    int end_;    // slot after the last admitted vehicle
    int bound_;  // slot of the first vehicle that stops for its signal, or the slot after the last vehicle
    int refused_ = -1;
    KeepClearHold hold_;  // why the vehicle tested last may not enter
};

// Adds the claims of the vehicles of a lane that will pass the line in its next green: of turning vehicles, and of the
// first vehicle if it was refused in the last green.
void add_claims(const Model& model, State& state, int lane) {
    const VehicleArrays& v = state.vehicles;
    ClearingState& clearing = state.clearing;
    const LaneBlock& block = state.blocks[at(lane)];
    const LanePlan& plan = state.plan.lane(lane);
    if (!plan.has_movement_signals && state.signals.lights[at(plan.signal_group)] == Light::green) return;
    ArrivalForecast forecast(model, state, lane);
    for (int slot = block.first; slot < block.past_last(); ++slot) {
        const double arrival_s = forecast.next_s(slot);
        const int next = v.next_lane[at(slot)];
        if (next < 0 || state.plan.lane(next).origin != lane) break;
        const int group = state.plan.signal_group_for(lane, next);
        if (state.signals.lights[at(group)] == Light::green || v.position_m[at(slot)] > plan.stop_line_m) continue;
        if (arrival_s > next_green_duration_s(model, state, group)) break;
        const bool is_urgent = was_refused_since(model, state, lane, slot, state.signals.green_start_tick[at(group)]);
        if (!(is_urgent || clearing.connections[at(next)].turns) || !has_v2v(state, slot)) continue;
        const int exit = state.plan.lane(next).exit;
        clearing.claims_m[at(exit)] += space_needed_m(v, slot);
        if (is_urgent) clearing.urgent_claims_m[at(exit)] += space_needed_m(v, slot);
    }
}

}  // namespace

void update_claims(const Model& model, State& state, Partition& part) {
    ClearingState& clearing = state.clearing;
    if (state.tick % clearing.claim_ticks != 0) return;
    for (const int exit : part.exits) clearing.claims_m[at(exit)] = clearing.urgent_claims_m[at(exit)] = 0.0;
    for (const int lane : part.occupied) {
        if (state.plan.lane(lane).signal_group >= 0) add_claims(model, state, lane);
    }
    // Our choice: half of the lane remains for the vehicles without a claim.
    constexpr double kMaxClaimedShare = 0.5;
    for (const int exit : part.exits) {
        clearing.claims_m[at(exit)] =
            std::min(clearing.claims_m[at(exit)], kMaxClaimedShare * state.plan.lane(exit).stop_line_m);
    }
}

int admit_vehicles(const Model& model, State& state, int lane, int stopping_slot) {
    return LaneAdmission(model, state, lane, stopping_slot).run();
}

void init_clearing(const Model& model, State& state) {
    // All three values are our choice. Every vehicle exceeds this share of its maximum acceleration when it starts.
    constexpr double kSureAccelerationShare = 0.5;
    constexpr double kAnnouncementInterval_s = 0.5;
    constexpr double kClaimInterval_s = 2.0;
    if (!model.rules.clearing) return;
    ClearingState& clearing = state.clearing;
    const std::size_t lanes = model.graph.lanes.size();
    clearing.announcements.resize(lanes);
    clearing.last_admitted.assign(lanes, -1);
    clearing.latest_admissions.resize(lanes);
    clearing.bookings.resize(lanes);
    clearing.refusals.resize(lanes);
    clearing.claims_m.assign(lanes, 0.0);
    clearing.urgent_claims_m.assign(lanes, 0.0);
    clearing.connections.resize(lanes);
    double limit_mps = 1.0;  // highest speed limit
    for (int lane = 0; lane < static_cast<int>(lanes); ++lane) {
        limit_mps = std::max(limit_mps, state.plan.free_speed_mps(lane));
        ClearingConnection& connection = clearing.connections[at(lane)];
        connection.turns = model.graph.lanes[at(lane)].turn != Turn::straight;
        for (const Conflict& conflict : state.plan.conflicts(lane)) {
            if (!conflict.yields) continue;
            if (connection.last_yield_m < 0.0) connection.first_wait_m = conflict.from_m;
            connection.last_yield_m = std::max(connection.last_yield_m, conflict.from_m);
        }
        if (connection.last_yield_m >= 0.0) clearing.connections[at(state.plan.lane(lane).origin)].last_yield_m = 0.0;
    }
    for (int policy = 0; policy < static_cast<int>(model.policies.size()); ++policy) {
        const DriverPlan& driver = model.driver_of(policy);
        const double time_gap_s =
            (desired_gap_m(model, policy, limit_mps) - desired_gap_m(model, policy, 0.0)) / limit_mps;
        clearing.policies.push_back({!driver.is_human, std::max(time_gap_s, 0.0),
                                     kSureAccelerationShare * driver.tables.cacc.acceleration_max_mps2});
        clearing.line_margin_m = std::max(clearing.line_margin_m, driver.tables.stop.margin_m);
    }
    clearing.announcement_ticks = std::max<std::int64_t>(to_ticks(kAnnouncementInterval_s, model.step_s), 1);
    clearing.claim_ticks = std::max<std::int64_t>(to_ticks(kClaimInterval_s, model.step_s), 1);
}

}  // namespace stopline
