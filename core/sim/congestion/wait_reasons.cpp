#include "sim/congestion/wait_reasons.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <vector>

#include "base/containers/index.h"
#include "base/speed_thresholds.h"
#include "sim/perception/look_ahead.h"
#include "sim/state/delay_log.h"
#include "sim/state/queries/gap.h"
#include "sim/state/queries/vehicle_place.h"

namespace stopline {

namespace {

constexpr double kQueueGap_m = 15.0;     // largest net gap between stopped vehicles of one queue
constexpr double kSearchRange_m = 30.0;  // range of the search for a leader downstream of the lane

// Returns the lane whose block contains `slot`. The blocks are in the order of NetworkPlan::lane_order().
int lane_with_slot(const State& state, int slot) {
    const LargeArray<int>& lanes = state.plan.lane_order();
    const auto begins_later = [&](int value, int lane) { return value < state.blocks[at(lane)].begin; };
    return *std::prev(std::upper_bound(lanes.begin(), lanes.end(), slot, begins_later));
}

class WaitReasonSearch {
public:
    WaitReasonSearch(const Model& model, const State& state, DelayWatch& watch)
        : model_(model), state_(state), v_(state.vehicles), watch_(watch) {}

    void find(StoppedQueue& queue) {
        find_direct_cause(queue);
        LastBlocker& last = watch_.lanes[at(queue.lane)].last_blocker;
        const int vehicle = v_.id[at(queue.first)];
        const bool is_first = is_at_stop_line(queue) || is_first_on_lane(queue);
        if (is_first && queue.direct_cause == DelayCause::signal) {
            // A vehicle at a red signal can have a blocker as well: a leader stopped past the stop line, or the vehicle
            // that blocked the waiting vehicle during the previous green. wait_for_leader() overwrites the direct
            // cause, so the cause is set to `signal` again.
            wait_for_leader(queue);
            queue.direct_cause = DelayCause::signal;
            if (queue.blocker < 0) queue.blocker = find_unmoved_blocker(last, vehicle);
        }
        if (queue.blocker < 0) return;
        queue.blocker_id = v_.id[at(queue.blocker)];
        queue.blocker_lane = lane_of_blocker(queue);
        if (is_first && queue.direct_cause != DelayCause::signal) {
            last = {vehicle, queue.blocker_id, queue.blocker_lane, static_cast<int>(state_.tick)};
        }
    }

private:
    bool is_stopped(int slot) const { return v_.speed_mps[at(slot)] < kStoppedSpeed_mps; }
    bool is_at_stop_line(const StoppedQueue& queue) const {
        return queue.first == state_.stop_lines.stop_slot[at(queue.lane)];
    }
    bool is_first_on_lane(const StoppedQueue& queue) const {
        return queue.first == state_.blocks[at(queue.lane)].first;
    }

    // Finds the blocker of the first vehicle of a queue, and the cause that stops this vehicle itself. A moving vehicle
    // counts as the blocker only if the stopped vehicle waits for it under the keep-clear rule.
    void find_direct_cause(StoppedQueue& queue) const {
        if (const YieldStop* const stop = yield_stops_of(state_, queue.lane).find(queue.first); stop != nullptr) {
            if (stop->reason == YieldReason::lane_change) return set(queue, -1, DelayCause::wrong_lane);
            const bool blocker_stopped = stop->blocker >= 0 && is_stopped(stop->blocker);
            const bool blocked = stop->reason != YieldReason::priority && blocker_stopped;
            return set(queue, blocker_stopped ? stop->blocker : -1,
                       blocked ? DelayCause::junction_blocking : DelayCause::yielding);
        }
        if (is_at_stop_line(queue)) {
            const KeepClearHold& hold = state_.stop_lines.held_at_green[at(queue.lane)];
            if (hold.is_refusal) return set(queue, hold.blocker, DelayCause::refusal);
            if (hold.blocker < 0) return set(queue, -1, DelayCause::signal);
            return set(queue, hold.blocker, hold.in_exit ? full_exit_cause(queue) : DelayCause::junction_blocking);
        }
        wait_for_leader(queue);
    }

    static void set(StoppedQueue& queue, int blocker, DelayCause cause) {
        queue.blocker = blocker;
        queue.direct_cause = cause;
    }

    void wait_for_leader(StoppedQueue& queue) const {
        if (is_first_on_lane(queue)) return wait_for_leader_beyond_lane(queue);
        const bool waits = is_stopped(queue.first - 1) && net_gap_m(v_, queue.first - 1, queue.first) <= kQueueGap_m;
        set(queue, waits ? queue.first - 1 : -1, DelayCause::none);
    }

    void wait_for_leader_beyond_lane(StoppedQueue& queue) const {
        set(queue, -1, DelayCause::none);
        const LeaderAhead ahead = leader_ahead(state_, queue.lane, queue.first, kSearchRange_m);
        if (ahead.slot < 0 || !is_stopped(ahead.slot)) return;
        if (rear_m(state_, ahead) - v_.position_m[at(queue.first)] > kQueueGap_m) return;
        const bool in_exit = is_exit_of(queue.lane, lane_with_slot(state_, ahead.slot));
        set(queue, ahead.slot, in_exit ? full_exit_cause(queue) : DelayCause::none);
    }

    int lane_of_blocker(const StoppedQueue& queue) const {
        return state_.blocks[at(queue.lane)].has(queue.blocker) ? queue.lane : lane_with_slot(state_, queue.blocker);
    }

    // Returns the slot of the vehicle that blocked `vehicle` during the previous green, if this blocker has not moved
    // since; else -1.
    int find_unmoved_blocker(const LastBlocker& last, int vehicle) const {
        if (last.vehicle != vehicle) return -1;
        const int slot = slot_on_lane(state_, last.blocker_lane, last.blocker);
        return slot >= 0 && v_.stopped_since_tick[at(slot)] <= last.tick ? slot : -1;
    }

    // Returns true if `lane` is a connection to the lane `exit`, or the approach lane of such a connection.
    bool is_exit_of(int lane, int exit) const {
        if (lane == exit) return false;
        const std::span<const int> connections = model_.connections_to.of(exit);
        return std::any_of(connections.begin(), connections.end(), [&](int connection) {
            return connection == lane || model_.graph.lanes[at(connection)].origin == lane;
        });
    }

    // Returns the delay cause of a queue whose exit lane is full: turn blocking if its first vehicle turns, else
    // spillback.
    DelayCause full_exit_cause(const StoppedQueue& queue) const {
        const bool is_inside = model_.graph.lanes[at(queue.lane)].origin >= 0;
        // Connection that the vehicle takes; -1: none.
        const int connection = is_inside ? queue.lane : v_.next_lane[at(queue.first)];
        const bool turns = connection >= 0 && model_.graph.lanes[at(connection)].turn != Turn::straight;
        return turns ? DelayCause::turn_blocking : DelayCause::spillback;
    }

    const Model& model_;
    const State& state_;
    const VehicleArrays& v_;
    DelayWatch& watch_;
};

// Finds the stopped vehicles of one lane. Updates VehicleArrays::stopped_since_tick.
class LaneScan {
public:
    LaneScan(const Model& model, State& state, Partition& part)
        : state_(state),
          v_(state.vehicles),
          part_(part),
          now_(static_cast<int>(state.tick)),
          interval_ticks_(static_cast<int>(model.rules.watch_ticks)) {}

    void scan(int lane) {
        const LaneBlock block = state_.blocks[at(lane)];
        const int stop_slot = state_.stop_lines.stop_slot[at(lane)];
        const YieldStops& yield_stops = yield_stops_of(state_, lane);
        const double* const speed_mps = v_.speed_mps.data();
        const int* const id = v_.id.data();
        int* const stopped_since_tick = v_.stopped_since_tick.data();
        StoppedQueue* queue = nullptr;  // queue that contains the vehicle ahead; nullptr: that vehicle moves
        for (int slot = block.first; slot < block.past_last(); ++slot) {
            if (speed_mps[slot] >= kStoppedSpeed_mps) {
                stopped_since_tick[slot] = now_;
                queue = nullptr;
                continue;
            }
            const bool joins = queue != nullptr && net_gap_m(v_, slot - 1, slot) <= kQueueGap_m && slot != stop_slot &&
                               yield_stops.find(slot) == nullptr;
            if (!joins) {
                queue = &part_.stopped_queues.emplace_back();
                queue->first = slot;
                queue->lane = lane;
                queue->earliest_stop_tick = now_;
            }
            ++queue->count;
            queue->earliest_stop_tick = std::min(queue->earliest_stop_tick, stopped_since_tick[slot]);
            part_.stops += stopped_since_tick[slot] == now_ - interval_ticks_ ? 1 : 0;
            part_.stopped_ids.push_back(id[slot]);
        }
    }

private:
    const State& state_;
    VehicleArrays& v_;
    Partition& part_;
    int now_;
    int interval_ticks_;
};

}  // namespace

void find_stopped_vehicles(const Model& model, State& state, Partition& part) {
    part.stopped_queues.clear();
    part.stopped_ids.clear();
    LaneScan scan(model, state, part);
    for (const int lane : part.occupied) scan.scan(lane);
}

void find_wait_reasons(const Model& model, const State& state, DelayWatch& watch, Partition& part) {
    WaitReasonSearch search(model, state, watch);
    for (StoppedQueue& queue : part.stopped_queues) search.find(queue);
}

}  // namespace stopline
