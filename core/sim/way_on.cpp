// Which way vehicles go on: the route from the lane that they are on, and where they turn after that.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>

#include "sim/phases.h"

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

// Limit that the vehicle's route sets at the end of the lane it is on.
float end_speed(const State& state, std::span<const int> route, int index) {
    if (at(index) + 1 >= route.size()) return kNoLowerLimit_mps;
    const double here = state.plan.lane(route[at(index)]).limit_mps;
    const double next = state.plan.lane(route[at(index) + 1]).limit_mps;
    return next < here ? static_cast<float>(next) : kNoLowerLimit_mps;
}

// Of routes that lead to different lanes of one edge, one to a lane from which fewest changes are left to be made; by turns, if several do.
int best_of_like(const Model& model, const State& state, int route, int slot) {
    const auto changes = [&](int way) {
        const VehicleRecord& vehicle = state.vehicles.record[at(slot)];
        const int onto = state.plan.route(way).back();
        if (vehicle.trip < 0) return std::abs(state.plan.beside(onto).way(vehicle.turn_after).changes);
        const int approach = model.graph.lanes[at(onto)].approach;
        const auto places = static_cast<int>(model.graph.approaches[at(approach)].lanes.size());
        return state.plan.changes_from(vehicle.trip, vehicle.leg + 1, onto, places);
    };
    int fewest = changes(route);
    int count = 0;
    for (int way = route; way >= 0; way = state.plan.like(way)) {
        if (changes(way) < fewest) fewest = changes(way), count = 0;
        if (changes(way) == fewest) ++count;
    }
    int left = state.vehicles.id[at(slot)] % count;
    for (int way = route; way >= 0; way = state.plan.like(way)) {
        if (changes(way) == fewest && left-- == 0) return way;
    }
    return route;
}

}  // namespace

void put_on_route(State& state, int slot, int index) {
    VehicleArrays& v = state.vehicles;
    const std::span<const int> route = state.plan.route(v.record[at(slot)].route);
    v.record[at(slot)].route_index = index;
    v.next_lane[at(slot)] = at(index) + 1 < route.size() ? route[at(index) + 1] : -1;
    v.end_speed_mps[at(slot)] = end_speed(state, route, index);
}

int draw_route(const Model& model, State& state, int inlet, std::int64_t k, bool chose_lane) {
    const DemandPlan::Inlet& in = model.demand.inlets[at(inlet)];
    if (in.approach_shares.empty()) {
        return chose_lane ? model.demand.route_on_lane(inlet, k) : model.demand.route_of(inlet, k);
    }
    auto& drawn = state.drawn[at(model.graph.lanes[at(in.lane)].approach)];
    std::array<std::int64_t, kMostTurns> of_routes{};
    const auto turn = [&](int route) { return static_cast<std::size_t>(state.plan.turn_of(route)); };
    for (std::size_t c = 0; c < in.routes.size(); ++c) of_routes[c] = drawn[turn(in.routes[c])];
    const std::int64_t all = std::accumulate(drawn.begin(), drawn.end(), std::int64_t{0});
    const int route = model.demand.route_that_is_due(inlet, k, {of_routes.data(), in.routes.size()}, all, chose_lane);
    ++drawn[turn(route)];
    return route;
}

void look_ahead(const Model& model, State& state, int slot, bool chose_lane) {
    VehicleRecord& record = state.vehicles.record[at(slot)];
    record.turn_after = Turn::none;
    const int exit = state.plan.route(record.route).back();
    if (model.graph.lanes[at(exit)].approach < 0 || model.lane_change.look_ahead == "off") return;
    const int inlet = state.inlet_of[at(exit)];
    if (inlet < 0) return;
    const std::int64_t k = state.inlets[at(inlet)].entered++;
    const int route = draw_route(model, state, inlet, k, chose_lane);
    record.turn_after = state.plan.turn_of(route);
}

void choose_way_on(const Model& model, State& state, int lane, int slot) {
    if (const VehicleRecord& own = state.vehicles.record[at(slot)]; own.trip >= 0) {
        if (state.plan.lane(lane).origin < 0) follow_trip(model, state, lane, slot, own.leg + 1);
        return;
    }
    const int inlet = state.inlet_of[at(lane)];
    if (inlet < 0) return;
    VehicleRecord& record = state.vehicles.record[at(slot)];
    const int approach = model.graph.lanes[at(lane)].approach;
    const int known = record.turn_after == Turn::none ? -1 : state.plan.route_with(approach, record.turn_after);
    record.route = known >= 0 ? known : draw_route(model, state, inlet, state.inlets[at(inlet)].entered++, false);
    take_way_of_lane(model, state, lane, slot);
    look_ahead(model, state, slot, false);
}

void take_way_of_lane(const Model& model, State& state, int lane, int slot) {
    VehicleRecord& record = state.vehicles.record[at(slot)];
    const int own = state.plan.beside(lane).way(state.plan.turn_of(record.route)).route;
    if (own >= 0) {
        record.route = state.plan.like(own) < 0 ? own : best_of_like(model, state, own, slot);
        return put_on_route(state, slot, 0);
    }
    record.route_index = 0;
    state.vehicles.next_lane[at(slot)] = -1;
    state.vehicles.end_speed_mps[at(slot)] = kNoLowerLimit_mps;
}

}  // namespace stopline
