#include "sim/junction/merging.h"

#include <algorithm>

#include "base/containers/index.h"
#include "base/simd/arithmetic.h"
#include "sim/junction/arrivals.h"
#include "sim/state/queries/stopping_distance.h"

namespace stopline {

namespace {

constexpr double kMinGap_m = 0.5;  // smallest net gap at which a candidate enters the conflict area

// Returns the net gap in m from the front of `candidate` on connection `lane` to the rear of a vehicle on connection
// `other`, whose front is at `other_front_m`. This is the distance of the candidate's front to the exit lane minus the
// distance of the other vehicle's rear to the exit lane. The gap is negative if the vehicles are side by side, or if
// the other vehicle is further from the exit lane than the candidate.
double merging_gap_m(const State& state, int lane, const Candidate& candidate, int other, int other_slot,
                     double other_front_m) {
    const double own_m = state.plan.lane(lane).length_m - candidate.front_m;
    const double other_m = state.plan.lane(other).length_m - other_front_m;
    return own_m - other_m - static_cast<double>(state.vehicles.length_m[at(other_slot)]);
}

}  // namespace

bool is_merge(const Model& model, const State& state, int lane, const Conflict& conflict) {
    return model.is_imported() && state.plan.lane(lane).exit == state.plan.lane(conflict.other).exit;
}

bool merges_first(const State& state, int lane, const Candidate& candidate, const Conflict& conflict, int other_slot,
                  double other_front_m) {
    const double own_m = state.plan.lane(lane).length_m - candidate.front_m;
    const double other_m = state.plan.lane(conflict.other).length_m - other_front_m;
    const bool is_in_area = candidate.front_m > conflict.from_m;
    const bool other_is_in_area = other_front_m > conflict.other_from_m;
    if (is_in_area != other_is_in_area) {
        // If only the candidate is in the area, it goes first. If only the other vehicle is in the area, the candidate
        // goes first only if it is wholly ahead of that vehicle.
        return is_in_area || own_m + static_cast<double>(state.vehicles.length_m[at(candidate.slot)]) <= other_m;
    }
    const auto& id = state.vehicles.id;
    return is_in_area && (own_m < other_m || (own_m == other_m && id[at(candidate.slot)] < id[at(other_slot)]));
}

double merging_stop_m(const Model& model, const State& state, int lane, const Candidate& candidate,
                      const Conflict& conflict, int other_slot, double other_front_m) {
    const VehicleArrays& v = state.vehicles;
    const double gap_m = merging_gap_m(state, lane, candidate, conflict.other, other_slot, other_front_m);
    // In full dynamics the brake of the candidate lags. As a reserve for this lag, the vehicle ahead is assumed to
    // brake as hard as it can.
    const double speed_mps = v.speed_mps[at(other_slot)];
    const double braking_m = model.meso
                                 ? comfortable_braking_distance_m(model.driver_of(v.policy[at(other_slot)]), speed_mps)
                                 : emergency_braking_distance_m(model, speed_mps);
    const double stop_m =
        candidate.front_m + gap_m - static_cast<double>(v.standstill_gap_m[at(candidate.slot)]) + braking_m;
    if (candidate.front_m > conflict.from_m) return stop_m;
    const double wait_m = conflict.from_m - model.driver_of(v.policy[at(candidate.slot)]).give_way.margin_m;
    return gap_m < kMinGap_m ? wait_m : std::max(stop_m, wait_m);
}

Wait zipper_wait(const Model& model, const State& state, int lane, const Candidate& candidate,
                 const Conflict& conflict) {
    const VehicleArrays& v = state.vehicles;
    const double own_m = state.plan.lane(lane).length_m - candidate.front_m;
    const double length_m = state.plan.lane(conflict.other).length_m;
    const int origin = state.plan.lane(conflict.other).origin;
    int leader = -1;
    double leader_front_m = -kNoWait_m;
    // Among the vehicles that are nearer to the exit lane than the candidate, finds the one furthest upstream. At equal
    // distances, the vehicle with the lower id counts as nearer.
    const auto look = [&](int on_lane, double offset_m) {
        const LaneBlock& block = state.blocks[at(on_lane)];
        for (int slot = block.first; slot < block.past_last(); ++slot) {
            const double front_m = v.position_m[at(slot)] + offset_m;
            const double distance_m = length_m - front_m;
            const bool is_ahead =
                distance_m < own_m || (distance_m == own_m && v.id[at(slot)] < v.id[at(candidate.slot)]);
            if (!is_ahead) break;
            if (on_lane == origin && v.next_lane[at(slot)] != conflict.other) continue;
            // Skip vehicles that stop at their line or yield. The candidate need not wait for them.
            if (slot == state.stop_lines.stop_slot[at(origin)] || is_yielding(state, slot)) continue;
            leader = slot;
            leader_front_m = front_m;
        }
    };
    // A vehicle with its front on the exit lane can have its rear on the other connection. As soon as the candidate has
    // room to enter the conflict area, it follows this vehicle as its leader on the exit lane, and need not wait.
    for (const JunctionOccupant& occupant : occupants_of(state, conflict.other)) {
        if (occupant.front_m <= length_m || (leader >= 0 && occupant.front_m >= leader_front_m)) continue;
        const double gap_m = merging_gap_m(state, lane, candidate, conflict.other, occupant.slot, occupant.front_m);
        if (gap_m >= kMinGap_m && candidate.front_m <= conflict.from_m) continue;
        leader = occupant.slot;
        leader_front_m = occupant.front_m;
    }
    look(conflict.other, 0.0);
    look(origin, -state.plan.lane(origin).length_m);
    if (leader < 0) return {};
    return {merging_stop_m(model, state, lane, candidate, conflict, leader, leader_front_m), leader,
            YieldReason::merging};
}

}  // namespace stopline
