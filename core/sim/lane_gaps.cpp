#include "sim/lane_gaps.h"

#include <algorithm>

#include "base/arithmetic.h"
#include "sim/phases.h"

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

constexpr double kLook_m = 150.0;

Neighbour neighbour(const VehicleArrays& v, int slot, double gap_m) {
    return {slot, gap_m, v.speed_mps[at(slot)], v.policy[at(slot)]};
}

double rear_m(const VehicleArrays& v, int slot) {
    return v.position_m[at(slot)] - static_cast<double>(v.length_m[at(slot)]);
}

// The nearest one beyond the end of the lane.
Neighbour beyond(const State& state, int lane, double front_m, int route) {
    const VehicleArrays& v = state.vehicles;
    if (route >= 0) {
        const Ahead seen = vehicle_ahead(state, lane, front_m, route, 0, kLook_m);
        return seen.slot < 0 ? Neighbour{} : neighbour(v, seen.slot, seen.start_m + rear_m(v, seen.slot) - front_m);
    }
    Neighbour nearest;
    for (const int next : state.plan.next(lane)) {
        const LaneBlock& block = state.blocks[at(next)];
        if (block.count == 0) continue;
        const double gap_m = state.plan.lane(lane).length_m + rear_m(v, block.last()) - front_m;
        if (gap_m < nearest.gap_m) nearest = neighbour(v, block.last(), gap_m);
    }
    return nearest;
}

// The nearest one on its way to the lane, from whichever side.
Neighbour coming(const Model& model, const State& state, int lane, double rear_at_m) {
    const VehicleArrays& v = state.vehicles;
    Neighbour nearest;
    const auto look = [&](int slot, double gap_m) {
        if (gap_m < nearest.gap_m) nearest = neighbour(v, slot, gap_m);
    };
    for (const int inside : model.leads_to[at(lane)]) {
        const LanePlan& way = state.plan.lane(inside);
        const LaneBlock& inner = state.blocks[at(inside)];
        if (inner.count > 0) {
            look(inner.first, way.length_m - v.position_m[at(inner.first)] + rear_at_m);
            continue;
        }
        const LaneBlock& before = state.blocks[at(way.origin)];
        for (int slot = before.first; slot < before.stop(); ++slot) {
            if (v.next_lane[at(slot)] != inside) continue;
            look(slot, state.plan.lane(way.origin).length_m - v.position_m[at(slot)] + way.length_m + rear_at_m);
            break;
        }
    }
    return nearest;
}

}  // namespace

Around around(const Model& model, const State& state, int lane, double front_m, double length_m, int route) {
    const VehicleArrays& v = state.vehicles;
    const LaneBlock& block = state.blocks[at(lane)];
    const double* const positions = v.position_m.data();
    Around found;
    const double* const end = positions + block.stop();
    const double* const behind =
        std::partition_point(positions + block.first, end, [=](double position_m) { return position_m >= front_m; });
    const auto slot = static_cast<int>(behind - positions);
    found.place = slot - block.first;
    found.ahead =
        found.place == 0 ? beyond(state, lane, front_m, route) : neighbour(v, slot - 1, rear_m(v, slot - 1) - front_m);
    found.behind = found.place == block.count ? coming(model, state, lane, front_m - length_m)
                                              : neighbour(v, slot, front_m - length_m - v.position_m[at(slot)]);
    return found;
}

double needed_gap_m(const Model& model, int policy, double speed_mps, double ahead_mps, double share) {
    // In full dynamics the radar is late, the brake lags, and those behind brake harder one after the other: less than comfortable braking
    // must do.
    constexpr double kGently_mps2 = 2.0;
    constexpr double kLate_s = 0.3;
    const double b_mps2 = model.meso ? model.krauss[at(policy)].deceleration_mps2 : kGently_mps2;
    const double late_m = model.meso ? 0.0 : kLate_s * std::max(speed_mps - ahead_mps, 0.0);
    const double braking_m = 0.5 * std::max(square(speed_mps) - square(ahead_mps), 0.0) / b_mps2 + late_m;
    const double least_m = model.policies[at(policy)].settings.standstill_gap_m;
    return std::max(share * desired_gap_m(model, policy, speed_mps), least_m) + braking_m;
}

}  // namespace stopline
