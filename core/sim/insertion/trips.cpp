#include "sim/insertion/trips.h"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <span>
#include <vector>

#include "base/containers/index.h"
#include "base/random.h"
#include "sim/insertion/insert_vehicle.h"
#include "sim/lane_change/route_choice.h"
#include "sim/perception/approaching_vehicles.h"
#include "sim/perception/look_ahead.h"
#include "sim/perception/reset_leader.h"
#include "sim/state/lane_blocks.h"
#include "sim/state/no_leader.h"
#include "sim/state/queries/desired_gap.h"
#include "sim/state/queries/gap.h"
#include "sim/state/queries/passage.h"
#include "sim/state/queries/stopping_distance.h"

namespace stopline {

namespace {

// Within this distance of the stop line, no new vehicle is inserted while a vehicle without priority is crossing the
// route of the new vehicle or has decided to cross it. The crossing vehicle decided before the new vehicle was there.
constexpr double kNearLine_m = 40.0;
// Positions in route files are rounded, so the gaps in a queue from a file can be a little too small. This tolerance
// allows such gaps.
constexpr double kPositionRounding_m = 0.01;

// Returns the position of the rear of the last vehicle on a lane, or kNoLeader_m if the lane is empty.
double last_rear_m(const State& state, int lane) {
    const LaneBlock& block = state.blocks[at(lane)];
    if (block.count == 0) return kNoLeader_m;
    return rear_m(state.vehicles, block.last());
}

// Returns the lane on which the vehicle of a trip enters.
int departure_lane(const Model& model, const State& state, int number) {
    const Trip& trip = model.demand.trips[at(number)];
    const std::vector<int>& lanes = model.graph.approaches[at(trip.approach)].lanes;
    const auto count = static_cast<int>(lanes.size());
    if (trip.depart_lane == Trip::DepartLane::given) return lanes[at(std::min(trip.lane, count - 1))];
    if (trip.depart_lane == Trip::DepartLane::rightmost) return lanes.back();
    if (trip.depart_lane == Trip::DepartLane::random) {
        const double drawn = random_uniform(model.seed, static_cast<std::uint64_t>(number), 0, Purpose::insertion);
        return lanes[at(std::min(static_cast<int>(drawn * count), count - 1))];
    }
    const auto lane_changes = [&](int lane) {
        return trip.depart_lane == Trip::DepartLane::best ? state.plan.lane_changes_from(number, 0, lane, count) : 0;
    };
    const auto is_better = [&](int a, int b) {
        const int changes_a = lane_changes(a);
        const int changes_b = lane_changes(b);
        return changes_a != changes_b ? changes_a < changes_b : last_rear_m(state, a) > last_rear_m(state, b);
    };
    int best = lanes.back();
    std::for_each(lanes.rbegin(), lanes.rend(), [&](int lane) {
        if (is_better(lane, best)) best = lane;
    });
    return best;
}

// The lane and the position at which a vehicle is to be inserted.
struct InsertionPoint {
    int lane = -1;
    int index = 0;  // number of vehicles on the lane that are ahead of the new vehicle
    double front_m = 0.0;
};

// Returns a random number in [0, 1) for the departure position of a trip. For DepartPosition::free, each step draws a
// new number.
double random_position(const Model& model, const State& state, int number) {
    const bool draws_each_step = model.demand.trips[at(number)].depart_position == Trip::DepartPosition::free;
    const std::uint64_t draw = draws_each_step ? 3 + static_cast<std::uint64_t>(state.tick) : 2;
    return random_uniform(model.seed, static_cast<std::uint64_t>(number), draw, Purpose::insertion);
}

// Returns the front position furthest downstream at which a vehicle may enter. This position is not beyond the stop
// line and not beyond the waiting position before the first conflict area.
double max_departure_m(const Model& model, const State& state, int lane, int number) {
    const Lane& road = model.graph.lanes[at(lane)];
    const DriverPlan& driver = model.driver_of(model.demand.trip_policies[at(number)]);
    const int route = state.plan.adjacent(lane).turn_option(model.demand.turn_of_trip(number, 0)).route;
    if (route < 0 || state.plan.route(route).size() < 2) return road.stop_line_m;
    const double first_conflict_m = state.plan.lane(state.plan.route(route)[1]).first_conflict_m;
    return std::max(std::min(road.stop_line_m, road.length_m + first_conflict_m - driver.give_way.margin_m), 0.0);
}

// Returns the front position at which a new vehicle enters. On a link lane (a lane between two intersections) that is
// long enough, the whole vehicle is on the lane, so that its rear is not inside the intersection upstream.
double departure_front_m(const Model& model, const State& state, int lane, int number) {
    using enum Trip::DepartPosition;
    const Trip& trip = model.demand.trips[at(number)];
    const double max_m = max_departure_m(model, state, lane, number);
    const double base_m = std::min(static_cast<double>(trip.length_m), max_m);
    const double min_m = model.connections_to.of(lane).empty() ? 0.0 : base_m;
    const LaneBlock& block = state.blocks[at(lane)];
    const auto within_lane = [&](double front_m) { return std::clamp(front_m, min_m, max_m); };
    switch (trip.depart_position) {
        case base:
            break;
        case given:
            return within_lane(static_cast<double>(trip.front_m));
        case last: {
            const int policy = model.demand.trip_policies[at(number)];
            if (block.count == 0) return within_lane(max_m - model.driver_of(policy).tables.stop.margin_m);
            const double last_mps = state.vehicles.speed_mps[at(block.last())];
            return within_lane(last_rear_m(state, lane) - desired_gap_m(model, policy, last_mps));
        }
        case random:
        case free:
            return std::lerp(base_m, max_m, random_position(model, state, number));
    }
    return base_m;
}

InsertionPoint insertion_point(const Model& model, const State& state, int number) {
    const int lane = departure_lane(model, state, number);
    const LaneBlock& block = state.blocks[at(lane)];
    InsertionPoint point{lane, block.count, departure_front_m(model, state, lane, number)};
    while (point.index > 0 && state.vehicles.position_m[at(block.first + point.index - 1)] < point.front_m) {
        --point.index;
    }
    return point;
}

// The gap to the leader of a new vehicle, and the speed of the leader.
struct EntryLeader {
    double gap_m = kNoLeader_m;  // net gap
    double speed_mps = 0.0;

    bool exists() const { return gap_m <= kLongestGap_m; }
};

EntryLeader entry_leader(const Model& model, const State& state, const InsertionPoint& point,
                         const RoutePosition& position) {
    const VehicleArrays& v = state.vehicles;
    if (point.index > 0) {
        const int leader = state.blocks[at(point.lane)].first + point.index - 1;
        return {rear_m(v, leader) - point.front_m, v.speed_mps[at(leader)]};
    }
    const LeaderAhead leader =
        leader_ahead(state, point.lane, point.front_m, position, model.common_driver().cacc.radar_range_m);
    if (leader.slot < 0) return {};
    return {rear_m(state, leader) - point.front_m, v.speed_mps[at(leader.slot)]};
}

// Returns true if the follower keeps a sufficient gap to the new vehicle: at least its desired gap plus the distance in
// which it brakes comfortably to the speed of the new vehicle. If the new vehicle is the last on its lane, returns true
// if vehicles that approach the lane can stop behind the new vehicle.
bool follower_has_room(const Model& model, const State& state, const InsertionPoint& point, double rear_m,
                       double speed_mps) {
    const LaneBlock& block = state.blocks[at(point.lane)];
    if (point.index == block.count) return !approaching_vehicle_cannot_stop(model, state, point.lane, rear_m);
    const VehicleArrays& v = state.vehicles;
    const std::size_t follower = at(block.first + point.index);
    const double follower_mps = v.speed_mps[follower];
    const CaccSettings& cacc = model.driver_of(v.policy[follower]).tables.cacc;
    const double braking_m = braking_distance_m(follower_mps, speed_mps, cacc.deceleration_comfort_mps2);
    return rear_m - v.position_m[follower] + kPositionRounding_m >=
           desired_gap_m(model, v.policy[follower], follower_mps) + braking_m;
}

// Returns the mean speed of the vehicles on a lane, or `empty_mps` if there are none.
double mean_speed_mps(const State& state, int lane, double empty_mps) {
    const LaneBlock& block = state.blocks[at(lane)];
    if (block.count == 0) return empty_mps;
    double sum_mps = 0.0;
    for (int slot = block.first; slot < block.past_last(); ++slot) sum_mps += state.vehicles.speed_mps[at(slot)];
    return sum_mps / block.count;
}

// Returns the speed that the trip asks for, at most `limit_mps`.
double wanted_speed_mps(const Model& model, const State& state, int number, int lane, double limit_mps,
                        const EntryLeader& leader) {
    const Trip& trip = model.demand.trips[at(number)];
    switch (trip.depart_speed) {
        case Trip::DepartSpeed::limit:
            return limit_mps;
        case Trip::DepartSpeed::given:
            return std::min(limit_mps, static_cast<double>(trip.speed_mps));
        case Trip::DepartSpeed::last:
            return leader.exists() ? std::min(limit_mps, leader.speed_mps) : limit_mps;
        case Trip::DepartSpeed::mean:
            return std::min(limit_mps, mean_speed_mps(state, lane, limit_mps));
        case Trip::DepartSpeed::random:
            break;
    }
    return limit_mps * random_uniform(model.seed, static_cast<std::uint64_t>(number), 1, Purpose::insertion);
}

// Returns the highest safe speed of a new vehicle behind its leader, at most `wanted_mps`. A result below 0 means that
// the gap is too small. A speed below both `wanted_mps` and the leader's speed is not tried: the new vehicle represents
// a vehicle that has followed its leader from upstream of the network, so it is not slower than the leader. If
// vehicles entered more slowly into smaller gaps, the flow would stay low for the rest of the run after a blockage. A
// trip with a given speed enters only with this speed.
double departure_speed_mps(const Model& model, const Trip& trip, int policy, double wanted_mps,
                           const EntryLeader& leader) {
    if (!leader.exists()) return wanted_mps;
    const double safe_mps =
        safe_entry_speed_mps(model, policy, leader.gap_m + kPositionRounding_m, leader.speed_mps, wanted_mps);
    const bool is_given = trip.depart_speed == Trip::DepartSpeed::given;
    return is_given && safe_mps < wanted_mps ? -1.0 : safe_mps;
}

// Returns true if a vehicle without priority that crosses the route of the new vehicle is inside the intersection and
// not yet past the conflict area, or has accepted a gap to enter.
bool crossing_vehicle_is_committed(const State& state, int route) {
    const std::span<const int> lanes = state.plan.route(route);
    if (lanes.size() < 2) return false;
    for (const Conflict& conflict : state.plan.conflicts(lanes[1])) {
        if (!conflict.other_yields) continue;
        const auto is_not_past = [&](const JunctionOccupant& occupant) {
            return occupant.rear_m < conflict.other_to_m;
        };
        const std::span<const JunctionOccupant> occupants = occupants_of(state, conflict.other);
        if (std::any_of(occupants.begin(), occupants.end(), is_not_past)) return true;
        const LaneBlock& approach = state.blocks[at(state.plan.lane(conflict.other).origin)];
        for (int slot = approach.first; slot < approach.past_last(); ++slot) {
            if (state.vehicles.record[at(slot)].accepted_gap_on == conflict.other) return true;
        }
    }
    return false;
}

// Stores the trip of a vehicle, so that VehicleNames can name the vehicle after it has left the network.
void record_trip(InsertionState& insertion, int vehicle, int trip) {
    insertion.vehicle_trips.resize(at(vehicle) + 1, -1);
    insertion.vehicle_trips.back() = trip;
}

// Inserts the vehicle of a trip at a point of its departure lane. Returns false if there is no room.
bool insert_trip(const Model& model, State& state, int number, const InsertionPoint& point) {
    const Trip& trip = model.demand.trips[at(number)];
    const Lane& road = model.graph.lanes[at(point.lane)];
    const int policy = model.demand.trip_policies[at(number)];
    const Turn turn = model.demand.turn_of_trip(number, 0);
    const int route = state.plan.route_with(trip.approach, turn);
    const int lane_route = state.plan.adjacent(point.lane).turn_option(turn).route;
    const RoutePosition position{lane_route, 0, number, 0};
    const EntryLeader leader = entry_leader(model, state, point, position);
    double limit_mps = state.plan.free_speed_mps(point.lane, policy);
    // A vehicle that must change lanes for its turn enters so slowly that it needs at least 2 s to the stop line, from
    // the start of the lane. Our choice.
    constexpr double kLaneChange_1ps = 0.5;
    if (lane_route < 0) limit_mps = std::min(limit_mps, kLaneChange_1ps * road.stop_line_m);
    const double to_line_m = road.stop_line_m - point.front_m;
    if (road.signal_group >= 0)
        limit_mps = std::min(limit_mps, reliably_stoppable_speed_mps(model, model.driver_of(policy), to_line_m));
    const double wanted_mps = wanted_speed_mps(model, state, number, point.lane, limit_mps, leader);
    const double speed_mps = departure_speed_mps(model, trip, policy, wanted_mps, leader);
    const double rear_m = point.front_m - static_cast<double>(trip.length_m);
    if (speed_mps < 0.0 || !follower_has_room(model, state, point, rear_m, speed_mps)) return false;
    if (lane_route >= 0 && to_line_m < kNearLine_m && crossing_vehicle_is_committed(state, lane_route)) return false;
    ensure_free_slot(state, point.lane);
    const int slot =
        insert_vehicle(model, state, {point.lane, point.front_m, speed_mps, trip.length_m, policy, route, false});
    state.vehicles.itinerary[at(slot)].trip = number;
    if (model.demand.trip_names) record_trip(state.insertion, state.vehicles.id[at(slot)], number);
    state.vehicles.record[at(slot)].junction_entry_tick = static_cast<int>(state.tick);
    enter_trip_edge(model, state, point.lane, slot, 0);
    finish_insertion(model, state, point.lane, slot);
    const LaneBlock& block = state.blocks[at(point.lane)];
    reset_leader(state.vehicles, slot + 1, block);
    // Let decide_stop_lines() choose again which vehicle stops at the line. The new vehicle can be the first vehicle
    // that is able to stop.
    if (slot < block.last()) state.stop_lines.lines[at(point.lane)].stopping_vehicle = -1;
    const double now_s = model.time_s(state.tick + 1);
    record_trip_crossing(state.records, state.vehicles, now_s, slot, model.trips_begin);
    state.insertion.trip_delays[at(trip.approach)].add(now_s - trip.depart_s);
    return true;
}

// Inserts waiting vehicles on an approach, in the order of their departure times. A vehicle without room blocks only
// later vehicles that depart on the same lane. Stops after kMaxFailures vehicles without room.
void insert_backlog(const Model& model, State& state, int approach) {
    constexpr std::size_t kMaxFailures = 16;
    std::vector<int>& trips = state.insertion.waiting_trips[at(approach)];
    const std::size_t lanes = model.graph.approaches[at(approach)].lanes.size();
    std::bitset<kMaxFailures> full;  // [lane index] true: no room on the lane; the last bit is for all further lanes
    std::size_t kept = 0;
    std::size_t k = 0;
    for (; k < trips.size() && full.count() < lanes && kept < kMaxFailures; ++k) {
        const InsertionPoint point = insertion_point(model, state, trips[k]);
        const std::size_t lane_index = std::min(at(state.plan.adjacent(point.lane).index), kMaxFailures - 1);
        if (!full[lane_index] && insert_trip(model, state, trips[k], point)) continue;
        full.set(lane_index);
        trips[kept++] = trips[k];
    }
    trips.erase(trips.begin() + static_cast<std::ptrdiff_t>(kept), trips.begin() + static_cast<std::ptrdiff_t>(k));
}

}  // namespace

void insert_trips(const Model& model, State& state) {
    const std::vector<Trip>& trips = model.demand.trips;
    InsertionState& insertion = state.insertion;
    std::vector<int>& approaches = insertion.approaches_with_backlog;
    const double now_s = model.time_s(state.tick + 1);
    for (; insertion.next_trip < trips.size() && trips[insertion.next_trip].depart_s < now_s; ++insertion.next_trip) {
        const int approach = trips[insertion.next_trip].approach;
        std::vector<int>& waiting = insertion.waiting_trips[at(approach)];
        if (waiting.empty()) {
            approaches.insert(std::lower_bound(approaches.begin(), approaches.end(), approach), approach);
        }
        waiting.push_back(static_cast<int>(insertion.next_trip));
    }
    std::erase_if(approaches, [&](int approach) {
        insert_backlog(model, state, approach);
        return insertion.waiting_trips[at(approach)].empty();
    });
}

}  // namespace stopline
