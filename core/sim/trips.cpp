// Vehicles with a way of their own (DemandPlan::trips): they enter when they are due and there is room, follow it edge by edge and leave at
// the end of its last one.
#include <algorithm>
#include <bitset>
#include <cmath>

#include "base/arithmetic.h"
#include "base/random.h"
#include "sim/phases.h"

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

constexpr double kNearLine_m = 40.0;  // to the stop line, within which one that enters cannot be seen coming
constexpr double kRounded_m = 0.01;   // places in files are: a queue that was written stands as it stood

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
    const auto changes_from = [&](int lane) {
        return own.where == Trip::Where::best ? state.plan.changes_from(trip, 0, lane, count) : 0;
    };
    const auto better = [&](int a, int b) {
        const int changes_a = changes_from(a);
        const int changes_b = changes_from(b);
        return changes_a != changes_b ? changes_a < changes_b : free_m(state, a) > free_m(state, b);
    };
    int best = lanes.back();
    std::for_each(lanes.rbegin(), lanes.rend(), [&](int lane) {
        if (better(lane, best)) best = lane;
    });
    return best;
}

// Where a vehicle would enter: place in the lane, counted from its first, and front.
struct Spot {
    int lane = -1;
    int place = 0;
    double front_m = 0.0;
};

double drawn_along(const Model& model, const State& state, int trip) {
    const bool anew = model.demand.trips[at(trip)].along == Trip::Along::free;
    const std::uint64_t draw = anew ? 3 + static_cast<std::uint64_t>(state.tick) : 2;
    return random_uniform(model.seed, static_cast<std::uint64_t>(trip), draw, Purpose::insertion);
}

// The furthest place from where it can still give way.
double furthest_entry_m(const Model& model, const State& state, int lane, int trip) {
    const Lane& road = model.graph.lanes[at(lane)];
    const int route = state.plan.beside(lane).way(model.demand.turn_of_trip(trip, 0)).route;
    if (route < 0 || state.plan.route(route).size() < 2) return road.stop_line_m;
    const double first_area_m = state.plan.lane(state.plan.route(route)[1]).first_area_m;
    return std::max(std::min(road.stop_line_m, road.length_m + first_area_m - model.give_way.margin_m), 0.0);
}

// Behind vehicles that may come its rear is on the lane.
double entry_front_m(const Model& model, const State& state, int lane, int trip) {
    using enum Trip::Along;
    const Trip& own = model.demand.trips[at(trip)];
    const double line_m = furthest_entry_m(model, state, lane, trip);
    const double base_m = std::min(static_cast<double>(own.length_m), line_m);
    const double least_m = model.leads_to[at(lane)].empty() ? 0.0 : base_m;
    const LaneBlock& block = state.blocks[at(lane)];
    const auto on_lane = [&](double front_m) { return std::clamp(front_m, least_m, line_m); };
    switch (own.along) {
        case base:
            break;
        case given:
            return on_lane(static_cast<double>(own.front_m));
        case last: {
            if (block.count == 0) return on_lane(line_m - model.driver.stop.margin_m);
            const int policy = model.demand.trip_policies[at(trip)];
            const double last_mps = state.vehicles.speed_mps[at(block.last())];
            return on_lane(free_m(state, lane) - desired_gap_m(model, policy, last_mps));
        }
        case random:
        case free:
            return std::lerp(base_m, line_m, drawn_along(model, state, trip));
    }
    return base_m;
}

Spot spot_of(const Model& model, const State& state, int trip) {
    const int lane = entry_lane(model, state, trip);
    const LaneBlock& block = state.blocks[at(lane)];
    Spot spot{lane, block.count, entry_front_m(model, state, lane, trip)};
    while (spot.place > 0 && state.vehicles.position_m[at(block.first + spot.place - 1)] < spot.front_m) --spot.place;
    return spot;
}

// The vehicle ahead of one that enters: net gap to its front, and speed.
struct Leader {
    double gap_m = 1e6;
    double speed_mps = 0.0;
};

Leader leader_of(const Model& model, const State& state, const Spot& spot, const OnTrip& on_trip) {
    const VehicleArrays& v = state.vehicles;
    if (spot.place > 0) {
        const std::size_t ahead = at(state.blocks[at(spot.lane)].first + spot.place - 1);
        return {v.position_m[ahead] - static_cast<double>(v.length_m[ahead]) - spot.front_m, v.speed_mps[ahead]};
    }
    const Ahead ahead = vehicle_ahead(state, spot.lane, spot.front_m, on_trip, model.driver.cacc.radar_range_m);
    if (ahead.slot < 0) return {};
    const double rear_m =
        ahead.start_m + v.position_m[at(ahead.slot)] - static_cast<double>(v.length_m[at(ahead.slot)]);
    return {rear_m - spot.front_m, v.speed_mps[at(ahead.slot)]};
}

// Whether whoever would follow it keeps a gap in which it can brake gently.
bool follower_has_room(const Model& model, const State& state, const Spot& spot, double rear_m, double speed_mps) {
    const LaneBlock& block = state.blocks[at(spot.lane)];
    if (spot.place == block.count) return !somebody_comes(model, state, spot.lane, rear_m);
    const VehicleArrays& v = state.vehicles;
    const std::size_t follower = at(block.first + spot.place);
    const double follower_mps = v.speed_mps[follower];
    const double braking_m =
        std::max(square(follower_mps) - square(speed_mps), 0.0) / (2.0 * model.driver.cacc.deceleration_comfort_mps2);
    return rear_m - v.position_m[follower] + kRounded_m >=
           desired_gap_m(model, v.policy[follower], follower_mps) + braking_m;
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
        return leader.gap_m + kRounded_m >= desired_gap_m(model, policy, speed_mps) + braking_m;
    };
    if (fits(wanted_mps)) return wanted_mps;
    const double slower_mps = std::min(wanted_mps, leader.speed_mps);
    return trip.fast != given && fits(slower_mps) ? slower_mps : -1.0;
}

// Whether somebody goes across the way of one that has priority, and could not know that it would come.
bool somebody_crosses(const State& state, int route) {
    const std::span<const int> lanes = state.plan.route(route);
    if (lanes.size() < 2) return false;
    for (const Conflict& conflict : state.plan.conflicts(lanes[1])) {
        if (!conflict.other_yields) continue;
        const auto still_there = [&](const Insider& w) { return w.rear_m < conflict.other_to_m; };
        const std::vector<Insider>& inside = state.insiders[at(conflict.other)];
        if (std::any_of(inside.begin(), inside.end(), still_there)) return true;
        const LaneBlock& before = state.blocks[at(state.plan.lane(conflict.other).origin)];
        for (int slot = before.first; slot < before.stop(); ++slot) {
            if (state.vehicles.record[at(slot)].cleared_for == conflict.other) return true;
        }
    }
    return false;
}

// Whether the vehicle could enter.
bool enter(const Model& model, State& state, int trip, const Spot& spot) {
    const Trip& own = model.demand.trips[at(trip)];
    const Lane& road = model.graph.lanes[at(spot.lane)];
    const int policy = model.demand.trip_policies[at(trip)];
    const int route = state.plan.route_with(own.approach, model.demand.turn_of_trip(trip, 0));
    const int way = state.plan.beside(spot.lane).way(model.demand.turn_of_trip(trip, 0)).route;
    const Leader leader = leader_of(model, state, spot, {way >= 0 ? way : route, 0, trip, 0});
    double limit_mps = state.plan.driven_mps(spot.lane);
    if (way < 0) limit_mps = std::min(limit_mps, 0.5 * road.stop_line_m);  // it has to change lanes first
    const double room_mps = std::sqrt(2.0 * model.driver.stop.deceleration_mps2 * (road.stop_line_m - spot.front_m));
    if (road.signal_group >= 0) limit_mps = std::min(limit_mps, room_mps);
    const double speed_mps = entry_speed_mps(model, own, trip, policy, limit_mps, leader);
    const double rear_m = spot.front_m - static_cast<double>(own.length_m);
    if (speed_mps < 0.0 || !follower_has_room(model, state, spot, rear_m, speed_mps)) return false;
    if (way >= 0 && road.stop_line_m - spot.front_m < kNearLine_m && somebody_crosses(state, way)) return false;
    make_room(state, spot.lane);
    const int slot =
        put_on_lane(model, state, {spot.lane, spot.front_m, speed_mps, own.length_m, policy, route, false});
    state.vehicles.record[at(slot)].trip = trip;
    state.vehicles.record[at(slot)].inside_since = static_cast<int>(state.tick);
    follow_trip(model, state, spot.lane, slot, 0);
    begin_to_drive(model, state, spot.lane, slot);
    const LaneBlock& block = state.blocks[at(spot.lane)];
    follow_anew(state, slot + 1, block);
    if (slot < block.last()) state.stop_lines[at(spot.lane)].stopper = -1;  // it may be another one now
    note_trip(state, model.trips_begin, slot, model.time_s(state.tick + 1));
    return true;
}

// Those of one approach in their order, lane by lane: who has a lane of its own waits only for some on the others.
void enter_all(const Model& model, State& state, int approach) {
    constexpr std::size_t kLookedAt = 16;  // that cannot enter
    std::vector<int>& trips = state.waiting_trips[at(approach)];
    const std::size_t lanes = model.graph.approaches[at(approach)].lanes.size();
    std::bitset<kLookedAt> full;  // by place of the lane; those further right share the last bit
    std::size_t kept = 0;
    std::size_t k = 0;
    for (; k < trips.size() && full.count() < lanes && kept < kLookedAt; ++k) {
        const Spot spot = spot_of(model, state, trips[k]);
        const std::size_t place = std::min(at(state.plan.beside(spot.lane).place), kLookedAt - 1);
        if (!full[place] && enter(model, state, trips[k], spot)) continue;
        full.set(place);
        trips[kept++] = trips[k];
    }
    trips.erase(trips.begin() + static_cast<std::ptrdiff_t>(kept), trips.begin() + static_cast<std::ptrdiff_t>(k));
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
        std::vector<int>& waiting = state.waiting_trips[at(approach)];
        if (waiting.empty()) {
            state.waiting_at.insert(std::lower_bound(state.waiting_at.begin(), state.waiting_at.end(), approach),
                                    approach);
        }
        waiting.push_back(static_cast<int>(state.next_trip));
    }
    std::erase_if(state.waiting_at, [&](int approach) {
        enter_all(model, state, approach);
        return state.waiting_trips[at(approach)].empty();
    });
}

}  // namespace stopline
