// Vehicles with a way of their own (DemandPlan::trips): they enter when they are due and there is room, follow it edge by edge and leave at
// the end of its last one.
#include <algorithm>
#include <cmath>

#include "base/arithmetic.h"
#include "base/random.h"
#include "sim/phases.h"

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

// Changes that a vehicle with that turn has to make from a lane.
int changes_from(const State& state, int lane, Turn turn) {
    return std::abs(state.plan.beside(lane).way(turn).changes);
}

double free_m(const State& state, int lane) {
    const LaneBlock& block = state.blocks[at(lane)];
    if (block.count == 0) return 1e6;
    const VehicleArrays& v = state.vehicles;
    return v.position_m[at(block.last())] - static_cast<double>(v.length_m[at(block.last())]);
}

// On which lane of its approach it enters.
int entry_lane(const Model& model, const State& state, int trip) {
    const Trip& own = model.demand.trips[at(trip)];
    const std::vector<int>& lanes = model.graph.approaches[at(own.approach)].lanes;
    const auto count = static_cast<int>(lanes.size());
    if (own.where == Trip::Where::lane) return lanes[at(std::min(own.lane, count - 1))];
    if (own.where == Trip::Where::rightmost) return lanes.back();
    if (own.where == Trip::Where::random) {
        const double drawn = random_uniform(model.seed, static_cast<std::uint64_t>(trip), 0, Purpose::insertion);
        return lanes[at(std::min(static_cast<int>(drawn * count), count - 1))];
    }
    const Turn turn = model.demand.turn_of_trip(trip, 0);
    const auto better = [&](int a, int b) {
        const int changes_a = own.where == Trip::Where::best ? changes_from(state, a, turn) : 0;
        const int changes_b = own.where == Trip::Where::best ? changes_from(state, b, turn) : 0;
        return changes_a != changes_b ? changes_a < changes_b : free_m(state, a) > free_m(state, b);
    };
    int best = lanes.back();
    std::for_each(lanes.rbegin(), lanes.rend(), [&](int lane) {
        if (better(lane, best)) best = lane;
    });
    return best;
}

// The vehicle ahead of one that enters: net gap to a front at `front_m`, and speed.
struct Leader {
    double gap_m = 1e6;
    double speed_mps = 0.0;
};

Leader leader_of(const Model& model, const State& state, int lane, double front_m, int route) {
    const VehicleArrays& v = state.vehicles;
    const LaneBlock& block = state.blocks[at(lane)];
    if (block.count > 0) return {free_m(state, lane) - front_m, v.speed_mps[at(block.last())]};
    const Ahead ahead = vehicle_ahead(state, lane, front_m, route, 0, model.driver.cacc.radar_range_m);
    if (ahead.slot < 0) return {};
    const double rear_m =
        ahead.start_m + v.position_m[at(ahead.slot)] - static_cast<double>(v.length_m[at(ahead.slot)]);
    return {rear_m - front_m, v.speed_mps[at(ahead.slot)]};
}

// The speed with which it would enter behind that leader; below 0: there is no room.
double entry_speed_mps(const Model& model, const Trip& trip, int number, int policy, double limit_mps,
                       const Leader& leader) {
    using enum Trip::Fast;
    const bool alone = leader.gap_m > 1e5;
    double wanted_mps = limit_mps;
    if (trip.fast == given) wanted_mps = std::min(limit_mps, static_cast<double>(trip.speed_mps));
    if (trip.fast == as_last && !alone) wanted_mps = std::min(limit_mps, leader.speed_mps);
    if (trip.fast == random) {
        wanted_mps *= random_uniform(model.seed, static_cast<std::uint64_t>(number), 1, Purpose::insertion);
    }
    if (alone) return wanted_mps;
    const double b = model.driver.stop.deceleration_mps2;
    const auto fits = [&](double speed_mps) {
        const double braking_m = std::max(square(speed_mps) - square(leader.speed_mps), 0.0) / (2.0 * b);
        return leader.gap_m >= desired_gap_m(model, policy, speed_mps) + braking_m;
    };
    if (fits(wanted_mps)) return wanted_mps;
    const double slower_mps = std::min(wanted_mps, leader.speed_mps);
    return trip.fast != given && fits(slower_mps) ? slower_mps : -1.0;
}

// Whether the vehicle could enter.
bool enter(const Model& model, State& state, int trip) {
    const Trip& own = model.demand.trips[at(trip)];
    const int lane = entry_lane(model, state, trip);
    const Lane& road = model.graph.lanes[at(lane)];
    const int policy = model.demand.trip_policies[at(trip)];
    const int route = state.plan.route_with(own.approach, model.demand.turn_of_trip(trip, 0));
    const int way = state.plan.beside(lane).way(model.demand.turn_of_trip(trip, 0)).route;
    const double front_m = std::min(static_cast<double>(own.length_m), road.stop_line_m);
    const Leader leader = leader_of(model, state, lane, front_m, way >= 0 ? way : route);
    double limit_mps = state.plan.driven_mps(lane);
    if (way < 0) limit_mps = std::min(limit_mps, 0.5 * road.stop_line_m);  // it has to change lanes first
    const double room_mps = std::sqrt(2.0 * model.driver.stop.deceleration_mps2 * (road.stop_line_m - front_m));
    if (road.signal_group >= 0) limit_mps = std::min(limit_mps, room_mps);
    const double speed_mps = entry_speed_mps(model, own, trip, policy, limit_mps, leader);
    if (speed_mps < 0.0 || somebody_comes(model, state, lane)) return false;
    make_room(state, lane);
    const int slot = put_on_lane(model, state, {lane, front_m, speed_mps, own.length_m, policy, route});
    state.vehicles.record[at(slot)].trip = trip;
    follow_trip(model, state, lane, slot, 0);
    begin_to_drive(model, state, lane, slot);
    note_trip(state, model.trips_begin, slot, model.time_s(state.tick + 1));
    return true;
}

}  // namespace

void note_trip(State& state, int detector, int slot, double time_s) {
    const VehicleArrays& v = state.vehicles;
    if (detector < 0) return;
    state.crossings.push_back({time_s, v.id[at(slot)], v.policy[at(slot)], detector,
                               static_cast<float>(v.speed_mps[at(slot)]), v.length_m[at(slot)]});
}

void follow_trip(const Model& model, State& state, int lane, int slot, int leg) {
    VehicleRecord& record = state.vehicles.record[at(slot)];
    record.leg = leg;
    record.turn_after = state.plan.turn_of_trip(record.trip, leg + 1);
    record.route =
        state.plan.route_with(model.graph.lanes[at(lane)].approach, state.plan.turn_of_trip(record.trip, leg));
    take_way_of_lane(model, state, lane, slot);
}

void insert_trips(const Model& model, State& state) {
    const std::vector<Trip>& trips = model.demand.trips;
    const double now_s = model.time_s(state.tick + 1);
    for (; state.next_trip < trips.size() && trips[state.next_trip].depart_s < now_s; ++state.next_trip) {
        const int approach = trips[state.next_trip].approach;
        WaitingTrips& waiting = state.waiting_trips[at(approach)];
        if (waiting.trips.empty()) {
            state.waiting_at.insert(std::lower_bound(state.waiting_at.begin(), state.waiting_at.end(), approach),
                                    approach);
        }
        waiting.trips.push_back(static_cast<int>(state.next_trip));
    }
    std::erase_if(state.waiting_at, [&](int approach) {
        WaitingTrips& waiting = state.waiting_trips[at(approach)];
        while (waiting.entered < waiting.trips.size() && enter(model, state, waiting.trips[waiting.entered])) {
            ++waiting.entered;
        }
        if (waiting.entered < waiting.trips.size()) return false;
        waiting = {};
        return true;
    });
}

}  // namespace stopline
