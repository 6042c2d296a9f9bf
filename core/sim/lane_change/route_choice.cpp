// Chooses two things for each vehicle: the route that begins on its current lane, and its turns at the second and third
// intersection ahead.
#include "sim/lane_change/route_choice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>

#include "base/containers/index.h"
#include "sim/lane_change/preferred_lane.h"
#include "sim/state/queries/stopping_distance.h"

namespace stopline {

namespace {

// Returns the highest speed at the start of the lane route[next] from which a vehicle on a trip can still stop
// comfortably on the exit lane of the route. This matters on edges of imported networks that are too short to stop from
// the speed limit. Returns kNoLowerLimit_mps if the vehicle need not change lanes on the exit lane, or cannot change
// lanes there because the exit lane is too short.
double lane_change_entry_speed_mps(const Model& model, const State& state, std::span<const int> route, int next,
                                   int slot) {
    const VehicleRecord& record = state.vehicles.record[at(slot)];
    const int exit = route.back();
    if (record.following_turn == Turn::none || !state.vehicles.itinerary_of(at(slot)).has_trip())
        return kNoLowerLimit_mps;
    const int changes = state.plan.adjacent(exit).turn_option(record.following_turn).lane_changes;
    const DriverPlan& driver = model.driver_of(state.vehicles.policy[at(slot)]);
    const double room_m = state.plan.lane(exit).stop_line_m - driver.tables.stop.margin_m;
    if (changes == 0 || room_m < state.vehicles.length_m[at(slot)]) return kNoLowerLimit_mps;
    double distance_m = room_m;
    for (std::size_t k = at(next); k + 1 < route.size(); ++k) distance_m += state.plan.lane(route[k]).length_m;
    return lane_change_stopping_speed_mps(driver, distance_m);
}

// Returns the highest speed at which the vehicle in `slot` may enter the next lane on the route. Returns
// kNoLowerLimit_mps if this speed is not below the limit of the current lane, or if there is no next lane.
float end_speed(const Model& model, const State& state, std::span<const int> route, int index, int slot) {
    if (at(index) + 1 >= route.size()) return kNoLowerLimit_mps;
    const double here = state.plan.lane(route[at(index)]).limit_mps;
    const double next = std::min(state.plan.entry_speed_mps(route[at(index) + 1]),
                                 lane_change_entry_speed_mps(model, state, route, index + 1, slot));
    return next < here ? static_cast<float>(next) : kNoLowerLimit_mps;
}

// Returns the parallel route whose exit lane requires the fewest later lane changes. Parallel routes have the same
// first lane and the same turn but different exit lanes. Among equally good routes the vehicle's id decides.
int best_parallel_route(const Model& model, const State& state, int route, int slot) {
    const auto changes = [&](int candidate) {
        const Itinerary itinerary = state.vehicles.itinerary_of(at(slot));
        const Turn following_turn = state.vehicles.record[at(slot)].following_turn;
        const int exit = state.plan.route(candidate).back();
        if (!itinerary.has_trip()) return std::abs(state.plan.adjacent(exit).turn_option(following_turn).lane_changes);
        const int approach = model.graph.lanes[at(exit)].approach;
        const auto lane_count = static_cast<int>(model.graph.approaches[at(approach)].lanes.size());
        return state.plan.lane_changes_from(itinerary.trip, itinerary.trip_edge + 1, exit, lane_count);
    };
    int fewest = changes(route);
    int count = 0;
    for (int candidate = route; candidate >= 0; candidate = state.plan.next_parallel_route(candidate)) {
        if (changes(candidate) < fewest) fewest = changes(candidate), count = 0;
        if (changes(candidate) == fewest) ++count;
    }
    int remaining = state.vehicles.id[at(slot)] % count;
    for (int candidate = route; candidate >= 0; candidate = state.plan.next_parallel_route(candidate)) {
        if (changes(candidate) == fewest && remaining-- == 0) return candidate;
    }
    return route;
}

// Draws a turn at the intersection downstream of a route's exit lane. Returns Turn::none if there is no such
// intersection, or if no route begins on the exit lane.
Turn draw_turn_beyond(const Model& model, State& state, int route, bool chose_lane) {
    const int exit = state.plan.route(route).back();
    if (model.graph.lanes[at(exit)].approach < 0) return Turn::none;
    const int inlet = state.insertion.inlet_of[at(exit)];
    if (inlet < 0) return Turn::none;
    const std::int64_t k = state.insertion.inlets[at(inlet)].entered++;
    return state.plan.turn_of(draw_route(model, state, inlet, k, chose_lane));
}

// Sets the turns of a vehicle on a path at the second and third intersection ahead. The exit lane of its route must
// have an approach, so that the turns can be found from each of its lanes.
void set_planned_turns(const Model& model, State& state, int slot) {
    VehicleRecord& record = state.vehicles.record[at(slot)];
    record.following_turn = Turn::none;
    record.third_turn = Turn::none;
    if (model.graph.lanes[at(state.plan.route(record.route).back())].approach < 0) return;
    const int path = state.vehicles.itinerary[at(slot)].path;
    record.following_turn = state.plan.turn_of(model.demand.path_routes[at(path)]);
    const int later = next_in_path(model.demand, path);
    if (later >= 0) record.third_turn = state.plan.turn_of(model.demand.path_routes[at(later)]);
}

}  // namespace

int next_in_path(const DemandPlan& demand, int index) { return demand.path_routes[at(index + 1)] < 0 ? -1 : index + 1; }

void set_route_index(const Model& model, State& state, int slot, int index) {
    VehicleArrays& v = state.vehicles;
    const std::span<const int> route = state.plan.route(v.record[at(slot)].route);
    v.record[at(slot)].route_index = index;
    v.next_lane[at(slot)] = at(index) + 1 < route.size() ? route[at(index) + 1] : -1;
    v.end_speed_mps[at(slot)] = end_speed(model, state, route, index, slot);
}

int draw_route(const Model& model, State& state, int inlet, std::int64_t k, bool chose_lane) {
    const DemandPlan::Inlet& in = model.demand.inlets[at(inlet)];
    if (in.approach_shares.empty()) {
        return chose_lane ? model.demand.route_for_chosen_lane(inlet, k) : model.demand.route_of(inlet, k);
    }
    auto& drawn = state.insertion.drawn_turns[at(model.graph.lanes[at(in.lane)].approach)];
    std::array<std::int64_t, kMaxTurns> drawn_per_route{};
    const auto turn = [&](int route) { return static_cast<std::size_t>(state.plan.turn_of(route)); };
    for (std::size_t c = 0; c < in.routes.size(); ++c) drawn_per_route[c] = drawn[turn(in.routes[c])];
    const std::int64_t total = std::accumulate(drawn.begin(), drawn.end(), std::int64_t{0});
    const int route =
        model.demand.balancing_route(inlet, k, {drawn_per_route.data(), in.routes.size()}, total, chose_lane);
    ++drawn[turn(route)];
    return route;
}

void draw_later_turns(const Model& model, State& state, int lane, int slot, bool chose_lane) {
    VehicleRecord& record = state.vehicles.record[at(slot)];
    if (!model.driver_of(state.vehicles.policy[at(slot)]).looks_ahead) return;
    if (state.vehicles.itinerary_of(at(slot)).path >= 0) {
        set_planned_turns(model, state, slot);
        update_preferred_lane(model, state, lane, slot);
        return;
    }
    if (record.following_turn == Turn::none) {
        record.following_turn = draw_turn_beyond(model, state, record.route, chose_lane);
    }
    if (record.following_turn != Turn::none) {
        const int exit = state.plan.route(record.route).back();
        const int next_route = state.plan.route_with(model.graph.lanes[at(exit)].approach, record.following_turn);
        record.third_turn = next_route < 0 ? Turn::none : draw_turn_beyond(model, state, next_route, false);
    }
    update_preferred_lane(model, state, lane, slot);
}

void enter_trip_edge(const Model& model, State& state, int lane, int slot, int trip_edge) {
    VehicleRecord& record = state.vehicles.record[at(slot)];
    Itinerary& itinerary = state.vehicles.itinerary[at(slot)];
    itinerary.trip_edge = trip_edge;
    record.following_turn = state.plan.turn_of_trip(itinerary.trip, trip_edge + 1);
    record.route =
        state.plan.route_with(model.graph.lanes[at(lane)].approach, state.plan.turn_of_trip(itinerary.trip, trip_edge));
    adopt_lane_route(model, state, lane, slot);
}

void choose_next_route(const Model& model, State& state, int lane, int slot) {
    const Itinerary itinerary = state.vehicles.itinerary_of(at(slot));
    if (itinerary.has_trip()) {
        if (state.plan.lane(lane).origin < 0) enter_trip_edge(model, state, lane, slot, itinerary.trip_edge + 1);
        return;
    }
    const int inlet = state.insertion.inlet_of[at(lane)];
    if (inlet < 0) return;
    VehicleRecord& record = state.vehicles.record[at(slot)];
    if (itinerary.path >= 0) {
        record.route = model.demand.path_routes[at(itinerary.path)];
        state.vehicles.itinerary[at(slot)].path = next_in_path(model.demand, itinerary.path);
        record.following_turn = std::exchange(record.third_turn, Turn::none);
        adopt_lane_route(model, state, lane, slot);
        draw_later_turns(model, state, lane, slot, false);
        return;
    }
    const int approach = model.graph.lanes[at(lane)].approach;
    const int known_route =
        record.following_turn == Turn::none ? -1 : state.plan.route_with(approach, record.following_turn);
    record.route = known_route >= 0
                       ? known_route
                       : draw_route(model, state, inlet, state.insertion.inlets[at(inlet)].entered++, false);
    record.following_turn = std::exchange(record.third_turn, Turn::none);
    adopt_lane_route(model, state, lane, slot);
    draw_later_turns(model, state, lane, slot, false);
}

void adopt_lane_route(const Model& model, State& state, int lane, int slot) {
    VehicleRecord& record = state.vehicles.record[at(slot)];
    update_preferred_lane(model, state, lane, slot);
    const int own = state.plan.adjacent(lane).turn_option(state.plan.turn_of(record.route)).route;
    if (own >= 0) {
        record.route = state.plan.next_parallel_route(own) < 0 ? own : best_parallel_route(model, state, own, slot);
        return set_route_index(model, state, slot, 0);
    }
    record.route_index = 0;
    state.vehicles.next_lane[at(slot)] = -1;
    state.vehicles.end_speed_mps[at(slot)] = kNoLowerLimit_mps;
}

}  // namespace stopline
