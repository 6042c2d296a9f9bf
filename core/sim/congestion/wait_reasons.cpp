#include "sim/congestion/wait_reasons.h"

#include <algorithm>
#include <cstddef>

#include "base/containers/index.h"
#include "base/speed_thresholds.h"
#include "sim/perception/look_ahead.h"
#include "sim/state/delay_log.h"

namespace stopline {

namespace {

constexpr double kQueueGap_m = 15.0;     // largest net gap between stopped vehicles of one queue
constexpr double kSearchRange_m = 30.0;  // range of the search for a leader downstream of the lane

class WaitSearch {
public:
    WaitSearch(const Model& model, const State& state, DelayWatch& watch)
        : model_(model), state_(state), v_(state.vehicles), w_(watch) {}

    void find(int slot) {
        const int lane = w_.lane[at(slot)];
        find_direct_cause(slot, lane);
        if (slot != state_.stop_lines.stop_slot[at(lane)] && slot != state_.blocks[at(lane)].first) return;
        LastBlocker& last = w_.last_blockers[at(lane)];
        int& waits_for = w_.waits_for[at(slot)];
        if (w_.direct_cause[at(slot)] == DelayCause::signal) {
            // A vehicle at a red signal can have a blocker as well: a leader stopped past the stop line, or the vehicle
            // that blocked the waiting vehicle during the previous green. wait_for_leader() overwrites the direct
            // cause, so the cause is set to `signal` again.
            wait_for_leader(slot, lane);
            w_.direct_cause[at(slot)] = DelayCause::signal;
            if (waits_for < 0) waits_for = find_unmoved_blocker(last, v_.id[at(slot)]);
        } else if (waits_for >= 0) {
            last = {v_.id[at(slot)], v_.id[at(waits_for)], w_.lane[at(waits_for)], static_cast<int>(state_.tick)};
        }
    }

private:
    bool is_stopped(int slot) const { return v_.speed_mps[at(slot)] < kStoppedSpeed_mps; }

    // Finds the blocker of a stopped vehicle, and the cause that stops this vehicle itself. A moving vehicle counts as
    // the blocker only if the stopped vehicle waits for it under the keep-clear rule.
    void find_direct_cause(int slot, int lane) {
        if (const YieldStop* const stop = yield_stop_of(slot, lane); stop != nullptr) {
            if (stop->reason == YieldReason::lane_change) return set(slot, -1, DelayCause::wrong_lane);
            const bool blocker_stopped = stop->blocker >= 0 && is_stopped(stop->blocker);
            const bool blocked = stop->reason != YieldReason::priority && blocker_stopped;
            return set(slot, blocker_stopped ? stop->blocker : -1,
                       blocked ? DelayCause::junction_blocking : DelayCause::yielding);
        }
        if (slot == state_.stop_lines.stop_slot[at(lane)]) {
            const KeepClearHold& hold = state_.stop_lines.held_at_green[at(lane)];
            if (hold.is_refusal) return set(slot, hold.blocker, DelayCause::refusal);
            if (hold.blocker < 0) return set(slot, -1, DelayCause::signal);
            return set(slot, hold.blocker, hold.in_exit ? full_exit_cause(slot) : DelayCause::junction_blocking);
        }
        wait_for_leader(slot, lane);
    }

    const YieldStop* yield_stop_of(int slot, int lane) const { return yield_stops_of(state_, lane).find(slot); }

    void set(int slot, int waits_for, DelayCause cause) {
        w_.waits_for[at(slot)] = waits_for;
        w_.direct_cause[at(slot)] = cause;
    }

    void wait_for_leader(int slot, int lane) {
        const LaneBlock& block = state_.blocks[at(lane)];
        int leader = slot - 1;
        double gap_m =
            v_.position_m[at(leader)] - static_cast<double>(v_.length_m[at(leader)]) - v_.position_m[at(slot)];
        if (slot == block.first) {
            const LeaderAhead ahead = leader_ahead(state_, lane, slot, kSearchRange_m);
            leader = ahead.slot;
            if (leader >= 0) {
                gap_m = ahead.lane_start_m + v_.position_m[at(leader)] - static_cast<double>(v_.length_m[at(leader)]) -
                        v_.position_m[at(slot)];
            }
        }
        if (leader < 0 || !is_stopped(leader) || gap_m > kQueueGap_m) return set(slot, -1, DelayCause::none);
        set(slot, leader, is_exit_of(lane, w_.lane[at(leader)]) ? full_exit_cause(slot) : DelayCause::none);
    }

    // Returns the slot of the vehicle that blocked `vehicle` during the previous green, if this blocker has not moved
    // since; else -1.
    int find_unmoved_blocker(const LastBlocker& last, int vehicle) const {
        if (last.vehicle != vehicle) return -1;
        const LaneBlock& block = state_.blocks[at(last.blocker_lane)];
        for (int slot = block.first; slot < block.past_last(); ++slot) {
            if (v_.id[at(slot)] == last.blocker) return v_.stopped_since[at(slot)] <= last.tick ? slot : -1;
        }
        return -1;
    }

    // Returns true if `lane` is a connection to the lane `exit`, or the approach lane of such a connection.
    bool is_exit_of(int lane, int exit) const {
        if (lane == exit) return false;
        const std::span<const int> connections = model_.connections_to.of(exit);
        return std::any_of(connections.begin(), connections.end(), [&](int connection) {
            return connection == lane || model_.graph.lanes[at(connection)].origin == lane;
        });
    }

    // Returns the delay cause of a vehicle whose exit lane is full: turn blocking if the vehicle turns, else spillback.
    DelayCause full_exit_cause(int slot) const {
        const int lane = w_.lane[at(slot)];
        const bool is_inside = model_.graph.lanes[at(lane)].origin >= 0;
        // Connection that the vehicle takes; -1: none.
        const int connection = is_inside ? lane : v_.next_lane[at(slot)];
        const bool turns = connection >= 0 && model_.graph.lanes[at(connection)].turn != Turn::straight;
        return turns ? DelayCause::turn_blocking : DelayCause::spillback;
    }

    const Model& model_;
    const State& state_;
    const VehicleArrays& v_;
    DelayWatch& w_;
};

}  // namespace

void find_stopped_vehicles(const Model& model, State& state, Partition& part) {
    DelayWatch& w = state.congestion.watch;
    const auto now = static_cast<int>(state.tick);
    const double* const speed_mps = state.vehicles.speed_mps.data();
    const int* const id = state.vehicles.id.data();
    int* const stopped_since = state.vehicles.stopped_since.data();
    part.earliest_stop_tick = now;
    part.stopped_slots.reset(static_cast<std::size_t>(part.present));
    for (const int lane : part.occupied) {
        const LaneBlock& block = state.blocks[at(lane)];
        std::fill_n(w.lane.begin() + block.first, block.count, lane);
        std::copy_n(id + block.first, block.count, w.vehicle.begin() + block.first);
        for (int slot = block.first; slot < block.past_last(); ++slot) {
            if (speed_mps[slot] >= kStoppedSpeed_mps) {
                stopped_since[slot] = now;
                continue;
            }
            part.stops += stopped_since[slot] + model.rules.watch_ticks == state.tick ? 1 : 0;
            w.traversal[at(slot)] = 0;
            w.cause[at(slot)] = DelayCause::none;
            part.earliest_stop_tick = std::min(part.earliest_stop_tick, stopped_since[slot]);
            part.stopped_slots.push(slot);
        }
    }
}

void find_wait_reasons(const Model& model, const State& state, DelayWatch& watch, const Partition& part) {
    WaitSearch search(model, state, watch);
    for (const int slot : part.stopped_slots) search.find(slot);
}

}  // namespace stopline
