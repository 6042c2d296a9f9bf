// Full dynamics: a vehicle follows who is nearest ahead of it. Where ways part, or a trip ends, that one may go another way, and hide one that
// stands or crawls on its own: that one is minded too, or it would come too late into view.
#include <algorithm>
#include <array>

#include "driver/acceleration_laws.h"
#include "sim/phases.h"

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

constexpr double kNothing_mps2 = 1e3;

// `own`: the last one on its way beyond its lane, which is not the one that it follows.
void mind(const Model& model, const State& state, int lane, int slot, const Ahead& own, NetworkPart& part) {
    const VehicleArrays& v = state.vehicles;
    const double speed_mps = v.speed_mps[at(slot)];
    double rear_m = own.start_m;
    if (!comes_by_another_way(state, lane, slot, own.slot)) {
        rear_m += v.position_m[at(own.slot)] - static_cast<double>(v.length_m[at(own.slot)]);
    }
    PredecessorView<double> p{};
    p.gap_m = rear_m - v.position_m[at(slot)];
    const double standstill_m = v.standstill_gap_m[at(slot)];
    if (p.gap_m > stopping_distance_m(model.driver, speed_mps) + standstill_m) return;
    p.closing_mps = speed_mps - v.speed_mps[at(own.slot)];
    p.acceleration_mps2 = v.acceleration_mps2[at(own.slot)];
    p.request_mps2 = v.request_mps2[at(own.slot)];
    const double growth_m = desired_gap_m(model, v.policy[at(slot)], speed_mps) - standstill_m;
    const double asks_mps2 = mind_acceleration(model.driver, speed_mps, standstill_m, std::max(growth_m, 0.0), p);
    if (asks_mps2 < kNothing_mps2) part.minding.push_back({slot, asks_mps2});
}

// Of the vehicles behind the first one on a lane, those that are the first for another way than its.
void look_past_followers(const Model& model, const State& state, int lane, NetworkPart& part) {
    constexpr double kLooks_m = 60.0;  // from its end, at least: of 50 km/h and a comfortable stop, with some to spare
    constexpr std::size_t kWays = 8;
    const VehicleArrays& v = state.vehicles;
    const LaneBlock& block = state.blocks[at(lane)];
    const LanePlan& plan = state.plan.lane(lane);
    const double from_m = plan.length_m - std::max(kLooks_m, stopping_distance_m(model.driver, plan.limit_mps));
    const std::size_t ways = std::min(state.plan.next(lane).size(), kWays);
    int before = v.next_lane[at(block.first)];
    std::array<int, kWays> met{before};
    std::size_t count = before >= 0 ? 1 : 0;
    for (int slot = block.first + 1; slot < block.stop() && v.position_m[at(slot)] > from_m; ++slot) {
        const int way = v.next_lane[at(slot)];
        if (way == before) continue;
        before = way;
        if (way < 0 || std::find(met.begin(), met.begin() + count, way) != met.begin() + count) continue;
        const double range_m = stopping_distance_m(model.driver, v.speed_mps[at(slot)]) + v.standstill_gap_m[at(slot)];
        const Ahead own = last_on_way(state, lane, slot, range_m);
        if (own.slot >= 0) mind(model, state, lane, slot, own, part);
        met[count++] = way;
        if (count == ways) return;
    }
}

}  // namespace

void look_past(const Model& model, const State& state, int lane, const Ahead& hidden, NetworkPart& part) {
    const int first = state.blocks[at(lane)].first;
    if (hidden.slot >= 0) mind(model, state, lane, first, hidden, part);
    // Nobody passes who stands at the head.
    const bool parts = state.plan.lane(lane).branches || !model.demand.trips.empty();
    if (parts && state.vehicles.speed_mps[at(first)] > 0.0) {
        look_past_followers(model, state, lane, part);
    }
}

}  // namespace stopline
