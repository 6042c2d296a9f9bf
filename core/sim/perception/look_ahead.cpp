// Finds the leader of each lane's first vehicle. The leader is on a lane further downstream.
#include "sim/perception/look_ahead.h"

#include <algorithm>
#include <cmath>

#include "base/containers/index.h"
#include "sim/perception/hidden_leaders.h"
#include "sim/performance/prefetch.h"
#include "sim/state/events.h"
#include "sim/state/no_leader.h"
#include "sim/state/queries/gap.h"
#include "sim/state/queries/platoon_interval.h"

namespace stopline {

namespace {

constexpr double kFar_m = 1e9;  // position of a rear that does not exist

// The stretch just downstream of a lane's end, where the connections from the lane still overlap. Finds the vehicle on
// this stretch whose rear is furthest upstream. Ignores vehicles whose front is at most `front_m` downstream of the
// lane's end, and vehicles that are clear of the observer's connection `own`. Of an unknown connection (-1), only
// vehicles that are clear of all connections count as clear.
class DivergeArea {
public:
    DivergeArea(const State& state, int lane, int own = -1, double front_m = kAll_m)
        : state_(state), v_(state.vehicles), own_(own), end_m_(state.plan.lane(lane).length_m), front_m_(front_m) {
        for (const int next : state.plan.next(lane)) search_connection(next);
    }
    // Return the vehicle found (slot -1: none) and the position of its rear, measured from the start of the lane.
    LeaderAhead vehicle() const { return found_; }
    double rear_m() const { return rear_m_; }

private:
    void search_connection(int connection) {
        const double clear_m = state_.plan.diverge_end_m(connection, own_);
        if (front_m_ >= clear_m && front_m_ != kAll_m) return;  // the observer itself is past this position
        const LaneBlock& block = state_.blocks[at(connection)];
        for (int slot = block.last(); slot >= block.first; --slot) {
            if (!consider(slot, 0.0, clear_m) || front_m_ == kAll_m) break;
        }
        if (!state_.plan.exit_reaches_back(connection)) return;
        const LanePlan& plan = state_.plan.lane(connection);
        const LaneBlock& exit = state_.blocks[at(plan.exit)];
        for (int slot = std::max(exit.past_last() - kReachBack, exit.first); slot < exit.past_last(); ++slot) {
            if (v_.record[at(slot)].previous_lane == connection) consider(slot, plan.length_m, clear_m);
        }
    }

    // Keeps the vehicle if its rear is the furthest upstream so far. `start_m`: start of the vehicle's lane, measured
    // from the start of the connection. Returns false if the rear is past `clear_m`, a position on the connection: the
    // vehicle is then clear of the observer's connection.
    bool consider(int slot, double start_m, double clear_m) {
        const double front_m = start_m + v_.position_m[at(slot)];
        const double beyond_m = front_m - v_.length_m[at(slot)];
        if (beyond_m >= clear_m) return false;
        if (front_m <= front_m_ || end_m_ + beyond_m >= rear_m_) return true;
        rear_m_ = end_m_ + beyond_m;
        found_ = {slot, end_m_ + start_m};
        return true;
    }

    static constexpr double kAll_m = -1.0;
    // This number of vehicles at the start of an exit lane is checked, because their rears may be on the connection.
    static constexpr int kReachBack = 2;

    const State& state_;
    const VehicleArrays& v_;
    int own_;
    double end_m_;
    double front_m_;
    double rear_m_ = kFar_m;
    LeaderAhead found_;
};

// Returns the leader beyond the end of the route, on the later edges of the trip, within `range_m`. Precondition: no
// vehicle is ahead on the route itself.
LeaderAhead ahead_on_trip(const State& state, int lane, double position_m, const RoutePosition& position,
                          double range_m) {
    const std::span<const int> route = state.plan.route(position.route);
    double start_m = 0.0;  // start of `current_lane`, measured from the start of `lane`
    int current_lane = lane;
    for (std::size_t k = at(position.route_index) + 1; k < route.size(); ++k) {
        start_m += state.plan.lane(current_lane).length_m;
        current_lane = route[k];
    }
    for (int trip_edge = position.trip_edge + 1;; ++trip_edge) {
        const Turn turn = state.plan.turn_of_trip(position.trip, trip_edge);
        const int turn_route = turn == Turn::none ? -1 : state.plan.adjacent(current_lane).turn_option(turn).route;
        // If several connections have this turn, the one that the vehicle will take is unknown.
        const bool is_known = turn_route >= 0 && state.plan.next_parallel_route(turn_route) < 0;
        const int own = is_known ? state.plan.route(turn_route)[1] : -1;
        const LeaderAhead diverging = DivergeArea(state, current_lane, own).vehicle();
        if (diverging.slot >= 0) return {diverging.slot, start_m + diverging.lane_start_m};
        if (turn_route < 0) return {};
        const std::span<const int> next_route = state.plan.route(turn_route);
        for (std::size_t k = 1; k < next_route.size(); ++k) {
            start_m += state.plan.lane(current_lane).length_m;
            current_lane = next_route[k];
            if (start_m - position_m > range_m) return {};
            const LaneBlock& block = state.blocks[at(current_lane)];
            if (block.count > 0) return {block.last(), start_m};
        }
    }
}

// Returns the leader of an observer on a route: the last vehicle of the first occupied lane from route[index] on.
// `position_m`: position of the observer on its own lane. `start_m`: start of route[index], measured from the start of
// the observer's lane. Ignores lanes that start more than `range_m` ahead of the observer.
STOPLINE_INLINE LeaderAhead last_vehicle_on(const State& state, std::span<const int> route, std::size_t index,
                                            double start_m, double position_m, double range_m) {
    for (std::size_t k = index; k < route.size(); ++k) {
        if (start_m - position_m > range_m) break;
        const LaneBlock& block = state.blocks[at(route[k])];
        if (block.count > 0) return {block.last(), start_m};
        start_m += state.plan.lane(route[k]).length_m;
    }
    return {};
}

// Returns true if `own`, the leader on the route, came from a lane that is not on the route. Its rear may then still be
// on that lane, so the position of this rear does not tell which leader is nearer: `own` or `diverging_leader`. Returns
// false if there is no `diverging_leader`.
bool rear_may_be_off_route(const State& state, std::span<const int> route, const LeaderAhead& own,
                           const LeaderAhead& diverging_leader) {
    if (diverging_leader.slot < 0) return false;
    const int previous_lane = state.vehicles.record[at(own.slot)].previous_lane;
    return previous_lane >= 0 && std::find(route.begin(), route.end(), previous_lane) == route.end();
}

// Returns the leader on the route, or a vehicle in the diverge area if this vehicle is nearer than the leader on the
// route. In the second case, stores the leader on the route in `hidden`. Inlined, because it runs once per lane and
// step.
STOPLINE_INLINE LeaderAhead ahead_on_route(const State& state, int lane, double position_m, int route_number, int index,
                                           double range_m, LeaderAhead* hidden = nullptr) {
    const LanePlan& here = state.plan.lane(lane);
    if (!here.branches && here.length_m - position_m > range_m) return {};
    LeaderAhead diverging_leader;
    double beside_rear_m = kFar_m;
    const std::span<const int> route = state.plan.route(route_number);
    const bool ends_here = at(index) + 1 == route.size();  // other vehicles may drive on beyond the end of the route
    if (here.branches || ends_here) {
        const DivergeArea diverge_area(state, lane, ends_here ? -1 : route[at(index) + 1]);
        diverging_leader = diverge_area.vehicle();
        beside_rear_m = diverge_area.rear_m();
    } else if (here.origin >= 0 && position_m < state.plan.diverge_end_m(lane)) {
        const double origin_m = state.plan.lane(here.origin).length_m;
        const DivergeArea diverge_area(state, here.origin, lane, position_m);
        diverging_leader = {diverge_area.vehicle().slot, diverge_area.vehicle().lane_start_m - origin_m};
        beside_rear_m = diverge_area.rear_m() - origin_m;
    }
    const LeaderAhead own = last_vehicle_on(state, route, at(index) + 1, here.length_m, position_m, range_m);
    if (own.slot >= 0) {
        double own_rear_m = rear_m(state, own);
        if (own_rear_m < own.lane_start_m && rear_may_be_off_route(state, route, own, diverging_leader))
            own_rear_m = own.lane_start_m;
        if (own_rear_m <= beside_rear_m) return own;
        if (hidden != nullptr && own.slot != diverging_leader.slot) *hidden = own;
    }
    return diverging_leader;
}

STOPLINE_INLINE LeaderAhead ahead_of(const State& state, int lane, int slot, double range_m,
                                     LeaderAhead* hidden = nullptr) {
    // A vehicle without a next lane leaves the network at the end of its lane, or must change lanes before. Only a
    // vehicle in the diverge area can still be in its way.
    if (state.vehicles.next_lane[at(slot)] < 0) {
        return DivergeArea(state, lane).vehicle();
    }
    const VehicleRecord& record = state.vehicles.record[at(slot)];
    const double position_m = state.vehicles.position_m[at(slot)];
    const LeaderAhead leader =
        ahead_on_route(state, lane, position_m, record.route, record.route_index, range_m, hidden);
    if (leader.slot >= 0) return leader;
    const Itinerary itinerary = state.vehicles.itinerary_of(at(slot));
    if (!itinerary.has_trip()) return leader;
    const RoutePosition position{record.route, record.route_index, itinerary.trip, itinerary.trip_edge};
    return ahead_on_trip(state, lane, position_m, position, range_m);
}

}  // namespace

LeaderAhead leader_ahead(const State& state, int lane, int slot, double range_m) {
    return ahead_of(state, lane, slot, range_m);
}

LeaderAhead leader_ahead(const State& state, int lane, double position_m, const RoutePosition& position,
                         double range_m) {
    if (position.route < 0) return DivergeArea(state, lane).vehicle();
    const LeaderAhead leader = ahead_on_route(state, lane, position_m, position.route, position.route_index, range_m);
    if (leader.slot >= 0 || position.trip < 0) return leader;
    return ahead_on_trip(state, lane, position_m, position, range_m);
}

LeaderAhead diverging_vehicle(const State& state, int lane, int connection) {
    return DivergeArea(state, lane, connection).vehicle();
}

LeaderAhead last_vehicle_on_route(const State& state, int lane, int slot, double range_m) {
    const VehicleRecord& record = state.vehicles.record[at(slot)];
    return last_vehicle_on(state, state.plan.route(record.route), at(record.route_index) + 1,
                           state.plan.lane(lane).length_m, state.vehicles.position_m[at(slot)], range_m);
}

namespace {

// Copies the V2V messages of the leader to the sentinel slot of the lane, the slot before the first vehicle. Copies
// neutral values if there is no leader.
void copy_v2v(const DelayRows& rows, VehicleArrays& v, std::size_t sentinel, std::size_t ahead, bool has_leader) {
    for (const std::size_t row : {rows.delayed, rows.older}) {
        const std::size_t to = row + sentinel;
        const std::size_t from = row + ahead;
        v.v2v_acceleration_mps2[to] = has_leader ? v.v2v_acceleration_mps2[from] : 0.0F;
        v.v2v_request_mps2[to] = has_leader ? v.v2v_request_mps2[from] : 0.0F;
        v.v2v_rate_1ps[to] = has_leader ? v.v2v_rate_1ps[from] : 1.0F;
    }
}

// Copies the id and the slot of the leader, and the place of the leader in its platoon, to the sentinel slot of the
// lane. `ahead`: slot of the leader; -1 if there is no leader.
void copy_platoon(bool has_platoon_leaders, VehicleArrays& v, std::size_t sentinel, std::size_t leader_slot,
                  int ahead) {
    V2vReceiver& copy = v.v2v.rest[sentinel];
    const V2vReceiver& leader = v.v2v.rest[leader_slot];
    v.id[sentinel] = ahead >= 0 ? v.id[leader_slot] : -1;
    copy.sender_slot = ahead;
    copy.platoon = ahead >= 0 ? leader.platoon : -1;
    copy.platoon_leader_slot = leader.platoon_leader_slot;
    copy.place_in_platoon = leader.place_in_platoon;
    if (!has_platoon_leaders) return;
    // The followers of a platoon leader that has just left the lane look for its messages in this slot for one step.
    for (int k = 0; k < v.v2v.stored_messages; ++k) {
        v.v2v.sent[v.v2v.index_of(static_cast<int>(sentinel), k)] =
            v.v2v.sent[v.v2v.index_of(static_cast<int>(leader_slot), k)];
    }
}

}  // namespace

bool rear_is_on_merging_path(const State& state, int lane, int slot, int ahead) {
    const VehicleArrays& v = state.vehicles;
    const VehicleRecord& leader = v.record[at(ahead)];
    double leader_rear_m = rear_m(v, ahead);
    if (leader_rear_m >= 0.0) return false;
    const std::span<const int> route = state.plan.route(v.record[at(slot)].route);
    const auto is_on_route = [&](int other_lane) {
        return std::find(route.begin(), route.end(), other_lane) != route.end();
    };
    if (leader.previous_lane >= 0 && state.plan.lane(leader.previous_lane).origin == lane)
        return false;  // the vehicle in slot `ahead` came over this lane, so it does not merge
    if (leader.previous_lane >= 0 && !is_on_route(leader.previous_lane)) return true;
    // If the previous lane is shorter than the vehicle, the rear may still be on the lane before the previous lane.
    if (leader.previous_lane >= 0) leader_rear_m += state.plan.lane(leader.previous_lane).length_m;
    return leader_rear_m < 0.0 && leader.second_previous_lane >= 0 && !is_on_route(leader.second_previous_lane);
}

void find_leaders_beyond_lanes(const Model& model, const State& state, VehicleArrays& v, Partition& part) {
    constexpr double kTouch_m = 1e-4;  // reserve, so that rounding does not make the gap negative
    part.extra_demands.clear();
    // A platoon can extend from a queue at a red signal across the stop line, and a human driver at rest observes when
    // the vehicle ahead starts. Both need the present leader also on lanes that sleep.
    const bool searches_sleeping_lanes = updates_platoons(model, state) || v.has_human_drivers;
    for (const int lane : searches_sleeping_lanes ? part.occupied : part.awake) {
        advance_prefetch(state, part.prefetch);
        const int head = state.blocks[at(lane)].first;
        const std::size_t sentinel = at(head - 1);
        LeaderAhead hidden;
        const LeaderAhead ahead = ahead_of(state, lane, head, model.common_driver().cacc.radar_range_m, &hidden);
        const bool has_leader = ahead.slot >= 0;
        const std::size_t leader_slot = at(has_leader ? ahead.slot : head);
        v.position_m[sentinel] = has_leader ? ahead.lane_start_m + v.position_m[leader_slot] : kNoLeader_m;
        v.speed_mps[sentinel] = v.speed_mps[leader_slot];
        v.length_m[sentinel] = v.length_m[leader_slot];
        v.acceleration_mps2[sentinel] = has_leader ? v.acceleration_mps2[leader_slot] : 0.0F;
        if (const double reach_m = v.position_m[sentinel] - v.position_m[at(head)];
            has_leader && reach_m < v.length_m[sentinel] && rear_is_on_merging_path(state, lane, head, ahead.slot)) {
            v.length_m[sentinel] = static_cast<float>(std::max(reach_m - kTouch_m, 0.0));
        }
        const double gap_m = net_gap_m(v, sentinel, head);
        // In the mesoscale mode the kernels count the overlaps with leaders beyond the lane.
        if (!model.meso && has_leader && gap_m < 0.0) {
            ++part.violations.overlaps;
            part.violations.record(
                {model.time_s(state.tick), Violation::Kind::overlap, lane, v.id[at(head)], v.id[leader_slot]});
        }
        if (v.has_powertrain()) {
            if (v.has_v2v_channel) {
                copy_platoon(model.v2v_plan.uses_platoon_leader, v, sentinel, leader_slot, ahead.slot);
            } else {
                copy_v2v(state.v2v, v, sentinel, leader_slot, has_leader);
            }
            react_to_hidden_leaders(model, state, lane, hidden, part);
        }
        if (v.has_platoon_limit) v.platoon.place[sentinel] = has_leader ? v.platoon.place[leader_slot] : kNoPlatoon;
        const int id = has_leader ? v.id[leader_slot] : -1;
        if (v.record[at(head)].leader_id == id) continue;
        // The leader has changed or disappeared. The present gap and closing speed replace the whole radar history.
        // Without a leader, the gap is that to a position far ahead (kNoLeader_m).
        v.record[at(head)].leader_id = id;
        v.is_platoon_leader[at(head)] = 1.0F;
        v.reset_radar(head, gap_m, v.speed_mps[at(head)] - v.speed_mps[sentinel]);
    }
}

}  // namespace stopline
