#include "sim/junction/deadlocks.h"

#include <algorithm>
#include <array>
#include <utility>

#include "base/containers/index.h"
#include "base/speed_thresholds.h"
#include "sim/junction/arrivals.h"
#include "sim/perception/look_ahead.h"
#include "sim/state/queries/vehicle_place.h"

namespace stopline {

namespace {

// A vehicle that waits, with the vehicle for which it waits.
struct WaitingVehicle {
    int slot = -1;
    int blocker = -1;
    // true: the vehicle could go if it had right of way, because its blocker has not reached their conflict area yet
    bool needs_only_right_of_way = false;
};

class WaitChains {
public:
    WaitChains(const State& state, Partition& part) : state_(state), v_(state.vehicles), part_(part) {}

    void resolve(int lane, int slot) {
        if (v_.speed_mps[at(slot)] >= kCrawlingSpeed_mps) return;
        constexpr std::size_t kMaxCycle = 16;
        std::array<WaitingVehicle, kMaxCycle> cycle;
        std::size_t count = 0;
        intersection_ = state_.plan.intersection_of(lane);
        int next = slot;
        do {
            if (count == kMaxCycle) return;
            cycle[count] = waiting(next);
            next = cycle[count++].blocker;
        } while (next >= 0 && next != slot);
        if (next < 0) return;
        const WaitingVehicle* first = nullptr;
        for (std::size_t k = 0; k < count; ++k) {
            if (!cycle[k].needs_only_right_of_way) continue;
            if (first == nullptr || rank(cycle[k].slot) < rank(first->slot)) first = &cycle[k];
        }
        // resolve() is called for several vehicles of the cycle, and each call finds the same `first`. Only the call
        // for the vehicle `first` records the resolution.
        if (first == nullptr || first->slot != slot) return;
        if (DeadlockResolution* const known = find_resolution(state_, part_, slot, first->blocker)) {
            known->last_needed_tick = state_.tick;
        } else {
            part_.deadlock_resolutions.push_back({v_.id[at(slot)], v_.id[at(first->blocker)], state_.tick});
        }
    }

private:
    std::pair<int, int> rank(int slot) const { return {v_.record[at(slot)].wait_since_tick, v_.id[at(slot)]}; }

    // Returns the vehicle in `slot` and its blocker: the blocker of its yield stop (YieldStop), else a stopped leader
    // close ahead. The result has no blocker if neither exists, or if the vehicle moves. It also has no blocker if the
    // vehicle is not at intersection_, because the decisions of this step for another intersection may not be complete
    // yet.
    WaitingVehicle waiting(int slot) const {
        const int lane = lane_of(state_, slot);
        if (v_.speed_mps[at(slot)] >= kCrawlingSpeed_mps || state_.plan.intersection_of(lane) != intersection_)
            return {slot};
        if (const YieldStop* const stop = yield_stops_of(state_, lane).find(slot);
            stop != nullptr && stop->blocker >= 0) {
            const bool may_go = stop->reason != YieldReason::deadlock && !is_in_path(lane, slot, stop->blocker);
            return {slot, stop->blocker, may_go};
        }
        if (!is_blocked_by_leader(state_, slot)) return {slot};
        const bool is_first = slot == state_.blocks[at(lane)].first;
        return {slot, is_first ? leader_ahead(state_, lane, slot, queue_look_ahead_m(state_, slot)).slot : slot - 1,
                false};
    }

    // Returns false if the connections of the vehicle and the blocker conflict and the front of the blocker has not
    // reached the conflict area yet. Returns true in all other cases.
    bool is_in_path(int lane, int slot, int blocker) const {
        const int connection = state_.plan.lane(lane).origin >= 0 ? lane : v_.next_lane[at(slot)];
        if (connection < 0) return true;
        const int blocker_lane = lane_of(state_, blocker);
        const bool blocker_is_inside = state_.plan.lane(blocker_lane).origin >= 0;
        const int other = blocker_is_inside ? blocker_lane : v_.next_lane[at(blocker)];
        const double front_m =
            v_.position_m[at(blocker)] - (blocker_is_inside ? 0.0 : state_.plan.lane(blocker_lane).length_m);
        for (const Conflict& conflict : state_.plan.conflicts(connection)) {
            if (conflict.other == other) return front_m > conflict.other_from_m;
        }
        return true;
    }

    const State& state_;
    const VehicleArrays& v_;
    Partition& part_;
    int intersection_ = -1;
};

}  // namespace

DeadlockResolution* find_resolution(const State& state, Partition& part, int first_slot, int second_slot) {
    const VehicleArrays& v = state.vehicles;
    const auto found = std::find_if(
        part.deadlock_resolutions.begin(), part.deadlock_resolutions.end(), [&](const DeadlockResolution& resolution) {
            return resolution.proceeds == v.id[at(first_slot)] && resolution.yields == v.id[at(second_slot)];
        });
    return found == part.deadlock_resolutions.end() ? nullptr : &*found;
}

DeadlockResolution* find_resolution_for(const State& state, Partition& part, int slot) {
    const auto found = std::find_if(
        part.deadlock_resolutions.begin(), part.deadlock_resolutions.end(),
        [&](const DeadlockResolution& resolution) { return resolution.proceeds == state.vehicles.id[at(slot)]; });
    return found == part.deadlock_resolutions.end() ? nullptr : &*found;
}

void resolve_deadlocks(const State& state, Partition& part) {
    WaitChains chains(state, part);
    for (const int lane : part.lanes_with_yield_stops) {
        const YieldStops& stops = yield_stops_of(state, lane);
        for (int k = 0; k < stops.count; ++k) {
            if (stops.stops[at(k)].blocker >= 0) chains.resolve(lane, stops.stops[at(k)].slot);
        }
    }
}

}  // namespace stopline
