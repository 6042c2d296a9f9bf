// Full dynamics: a vehicle follows who is nearest ahead of it. Where ways part, that one may go another way, and hide one that stands or
// crawls on its own: that one is minded too, or it would come too late into view.
#include <algorithm>
#include <array>

#include "driver/acceleration_laws.h"
#include "sim/phases.h"

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

constexpr double kNothing_mps2 = 1e3;

double minds_mps2(const Model& model, const State& state, int lane, int slot) {
    const VehicleArrays& v = state.vehicles;
    const double speed_mps = v.speed_mps[at(slot)];
    const double range_m = stopping_distance_m(model.driver, speed_mps) + v.standstill_gap_m[at(slot)];
    const Ahead own = last_on_way(state, lane, slot, range_m);
    if (own.slot < 0 || v.id[at(own.slot)] == v.record[at(slot)].predecessor) return kNothing_mps2;
    double rear_m = own.start_m;
    if (!comes_by_another_way(state, lane, slot, own.slot)) {
        rear_m += v.position_m[at(own.slot)] - static_cast<double>(v.length_m[at(own.slot)]);
    }
    PredecessorView<double> p{};
    p.gap_m = rear_m - v.position_m[at(slot)];
    if (p.gap_m > range_m) return kNothing_mps2;
    p.closing_mps = speed_mps - v.speed_mps[at(own.slot)];
    p.acceleration_mps2 = v.acceleration_mps2[at(own.slot)];
    p.request_mps2 = v.request_mps2[at(own.slot)];
    const double standstill_m = v.standstill_gap_m[at(slot)];
    const double growth_m = desired_gap_m(model, v.policy[at(slot)], speed_mps) - standstill_m;
    return mind_acceleration(model.driver, speed_mps, standstill_m, std::max(growth_m, 0.0), p);
}

void mind(const Model& model, const State& state, int lane, int slot, NetworkPart& part) {
    const double asks_mps2 = minds_mps2(model, state, lane, slot);
    if (asks_mps2 < kNothing_mps2) part.minding.push_back({slot, asks_mps2});
}

// Of the vehicles on a lane the first one for each way on.
void look_past_on(const Model& model, const State& state, int lane, NetworkPart& part) {
    constexpr double kLooks_m = 60.0;  // from its end: of 50 km/h and a comfortable stop, with some to spare
    constexpr std::size_t kWays = 8;
    const VehicleArrays& v = state.vehicles;
    const LaneBlock& block = state.blocks[at(lane)];
    const double from_m = state.plan.lane(lane).length_m - kLooks_m;
    const std::size_t ways = state.plan.next(lane).size();
    std::array<int, kWays> met{};
    std::size_t count = 0;
    for (int slot = block.first; slot < block.stop() && v.position_m[at(slot)] > from_m; ++slot) {
        const int way = v.next_lane[at(slot)];
        if (way < 0 || std::find(met.begin(), met.begin() + count, way) != met.begin() + count) continue;
        mind(model, state, lane, slot, part);
        met[count++] = way;
        if (count == ways || count == kWays) return;
    }
}

}  // namespace

void look_past_others(const Model& model, const State& state, NetworkPart& part) {
    part.minding.clear();
    for (const int lane : part.awake) {
        const LanePlan& plan = state.plan.lane(lane);
        const int first = state.blocks[at(lane)].first;
        if (plan.branches) {
            look_past_on(model, state, lane, part);
        } else if (plan.origin >= 0 && state.vehicles.position_m[at(first)] < state.plan.clear_m(lane)) {
            mind(model, state, lane, first, part);
        }
    }
}

}  // namespace stopline
