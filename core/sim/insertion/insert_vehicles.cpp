#include "sim/insertion/insert_vehicles.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/containers/index.h"
#include "base/random.h"
#include "sim/insertion/insert_vehicle.h"
#include "sim/lane_change/route_choice.h"
#include "sim/perception/look_ahead.h"
#include "sim/state/lane_blocks.h"
#include "sim/state/queries/desired_gap.h"
#include "sim/state/queries/gap.h"
#include "sim/state/queries/stopping_distance.h"

namespace stopline {

namespace {

constexpr double kBeforeStart_s = -1e9;

// Draws spacing policy and route of the next vehicle of an inlet, unless they have been drawn already.
void draw_next_vehicle(const Model& model, State& state, int number) {
    InletState& inlet = state.insertion.inlets[at(number)];
    if (inlet.next_policy >= 0) return;
    inlet.next_policy = model.demand.policy_of(number, inlet.entered);
    const std::vector<int>& paths = model.demand.inlets[at(number)].paths;
    inlet.next_path = paths.empty() ? -1 : paths[at(static_cast<int>(inlet.entered_arrivals))];
    if (inlet.next_path >= 0) {
        inlet.next_route = model.demand.path_routes[at(inlet.next_path)];
        return;
    }
    inlet.next_route = draw_route(model, state, number, inlet.entered, false);
}

// The position and speed with which a vehicle can enter.
struct Entry {
    bool is_possible = false;  // false: there is no room
    double position_m = 0.0;   // position of the front
    double speed_mps = 0.0;
};

bool is_connection_occupied(const Model& model, const State& state, int lane) {
    const std::span<const int> connections = model.connections_to.of(lane);
    return std::any_of(connections.begin(), connections.end(),
                       [&](int connection) { return state.blocks[at(connection)].count > 0; });
}

// Returns the route of the next vehicle of an inlet, from the lane of the inlet on. Returns -1 if the vehicle must
// change lanes for its turn.
int route_from_inlet(const Model& model, const State& state, int number) {
    const int lane = model.demand.inlets[at(number)].lane;
    const int route = state.insertion.inlets[at(number)].next_route;
    if (state.plan.route(route).front() == lane) return route;
    return state.plan.adjacent(lane).turn_option(state.plan.turn_of(route)).route;
}

// Does the work of entry_at() if the lane of the inlet is empty. The new vehicle has no leader on this lane, so the
// leader is searched further downstream. The rear of this leader can still be on the lane.
Entry entry_on_empty_lane(const Model& model, const State& state, int number, int policy, double front_m,
                          double max_mps) {
    const int lane = model.demand.inlets[at(number)].lane;
    const RoutePosition position{route_from_inlet(model, state, number)};
    const LeaderAhead leader = leader_ahead(state, lane, front_m, position, model.common_driver().cacc.radar_range_m);
    if (leader.slot < 0) return {true, front_m, max_mps};
    const VehicleArrays& v = state.vehicles;
    const double leader_mps = v.speed_mps[at(leader.slot)];
    const double gap_m = rear_m(state, leader) - front_m;
    const double safe_mps = safe_entry_speed_mps(model, policy, gap_m, leader_mps, max_mps);
    return {safe_mps >= 0.0, front_m, safe_mps};
}

// Returns the position and speed with which the next vehicle of an inlet can enter. On a link lane the new vehicle must
// lie wholly on the lane, so that its rear is not inside the intersection upstream.
Entry entry_at(const Model& model, const State& state, int number, int policy) {
    const int lane = model.demand.inlets[at(number)].lane;
    const double max_entry_mps = std::min({model.demand.entry_speed_mps, model.graph.lanes[at(lane)].limit_mps,
                                           model.vehicle_of(policy).maximum_speed_mps});
    const LaneBlock& block = state.blocks[at(lane)];
    if (is_connection_occupied(model, state, lane)) return {};
    const bool is_link = !model.connections_to.of(lane).empty();
    const double min_front_m = is_link ? model.vehicle_of(policy).length_m : 0.0;
    const double max_mps =
        is_link ? std::min(max_entry_mps, max_stoppable_speed_mps(model, model.driver_of(policy), lane, min_front_m))
                : max_entry_mps;
    if (block.count == 0) return entry_on_empty_lane(model, state, number, policy, min_front_m, max_mps);
    const VehicleArrays& v = state.vehicles;
    const std::size_t last = at(block.last());
    const double last_rear_m = rear_m(v, last);
    const double speed_mps = std::min(max_mps, v.speed_mps[last]);
    if (model.demand.is_saturated(number)) {
        const double position_m = last_rear_m - desired_gap_m(model, policy, speed_mps);
        return {position_m >= min_front_m, position_m, speed_mps};
    }
    const double gap_m = last_rear_m - min_front_m;
    if (!model.demand.forms_backlog(number)) {
        // Without arrival times, vehicles enter with the speed of the vehicle ahead, as one queue.
        const double needed_m =
            desired_gap_m(model, policy, speed_mps) + 0.5 * model.demand.entry_headway_s * speed_mps;
        return {gap_m >= needed_m, min_front_m, speed_mps};
    }
    const double safe_mps = safe_entry_speed_mps(model, policy, gap_m, v.speed_mps[last], max_mps);
    return {safe_mps >= 0.0, min_front_m, safe_mps};
}

// Copies acceleration and powertrain state from the leader to a new vehicle. The vehicle thus enters as part of an
// endless platoon. If the leader has another vehicle type, its torque, gear and lag do not fit the new vehicle. The new
// vehicle then keeps its values for steady driving, and takes over the braking of the leader but not its acceleration.
void copy_longitudinal_state(const Model& model, VehicleArrays& v, std::size_t i, std::size_t leader) {
    v.acceleration_mps2[i] = v.acceleration_mps2[leader];
    v.is_platoon_leader[i] = 0.0F;
    if (!v.has_powertrain()) return;
    if (v.type_of(i) != v.type_of(leader)) {
        const double mass_ratio =
            model.vehicles[at(v.type_of(i))].mass_kg / model.vehicles[at(v.type_of(leader))].mass_kg;
        v.acceleration_mps2[i] = std::min(v.acceleration_mps2[leader], 0.0F);
        v.request_mps2[i] = std::min(v.request_mps2[leader], 0.0F);
        v.brake_N[i] = v.brake_N[leader] * static_cast<float>(mass_ratio);
        return;
    }
    v.request_mps2[i] = v.request_mps2[leader];
    v.torque_Nm[i] = v.torque_Nm[leader];
    v.brake_N[i] = v.brake_N[leader];
    v.gear_time_s[i] = v.gear_time_s[leader];
    v.lag_s[i] = v.lag_s[leader];
    v.gear[i] = v.gear[leader];
}

void insert_at_inlet(const Model& model, State& state, int number, const Entry& entry) {
    const int lane = model.demand.inlets[at(number)].lane;
    InletState& inlet = state.insertion.inlets[at(number)];
    const double length_m = model.vehicle_of(inlet.next_policy).length_m;
    const NewVehicle vehicle{lane, entry.position_m, entry.speed_mps, length_m, inlet.next_policy, inlet.next_route};
    const int slot = insert_vehicle(model, state, vehicle);
    inlet.next_policy = -1;
    VehicleArrays& v = state.vehicles;
    const std::size_t i = at(slot);
    if (inlet.next_path >= 0) v.itinerary[i].path = next_in_path(model.demand, inlet.next_path);
    const bool is_first = state.blocks[at(lane)].count == 1;
    if (model.demand.saturated && !is_first && v.speed_mps[i - 1] <= entry.speed_mps) {
        copy_longitudinal_state(model, v, i, i - 1);
    }
    adopt_lane_route(model, state, lane, slot);
    draw_later_turns(model, state, lane, slot, true);
    finish_insertion(model, state, lane, slot);
    ++inlet.entered;
    inlet.last_entry_s = model.time_s(state.tick + 1);
}

// Marks the vehicles of the initial queues as already past the detectors that lie upstream of them, so that these
// detectors record no crossings. Detectors of zones are excluded: they record the vehicles as entering the zone.
void mark_detectors_passed(const Model& model, State& state) {
    for (std::size_t k = 0; k < model.detectors.size(); ++k) {
        const Detector& detector = model.detectors[k];
        if (detector.kind == Detector::Kind::zone) continue;
        const LaneBlock& block = state.blocks[at(detector.lane)];
        int& upstream = state.detectors.upstream[k];
        while (upstream > 0 && state.vehicles.position_m[at(block.past_last() - upstream)] >= detector.position_m) {
            --upstream;
        }
    }
}

// Reserves slots for the initial queues of all lanes at once. Otherwise the blocks of slots would grow lane by lane,
// and the vehicles of other lanes would have to be moved each time.
void reserve_initial_queues(const Model& model, State& state) {
    std::vector<int> expected(model.graph.lanes.size(), 0);
    for (const DemandPlan::Inlet& inlet : model.demand.inlets) {
        const double fitting = model.graph.lanes[at(inlet.lane)].stop_line_m / shortest_vehicle_m(model) + 1.0;
        expected[at(inlet.lane)] = static_cast<int>(std::min(fitting, static_cast<double>(inlet.vehicles)));
    }
    reserve_blocks(state, expected);
}

// Returns the random arrival time of the first vehicle of an inlet, as a fraction of the headway. Used for inlets where
// vehicles arrive at a constant headway.
double first_entry_offset(const Model& model, int number) {
    return random_uniform(model.seed, static_cast<std::uint64_t>(number), 0, Purpose::insertion);
}

// Returns the earliest time in s at which the next vehicle of an inlet may enter.
double next_entry_s(const Model& model, const State& state, int number) {
    const InletState& inlet = state.insertion.inlets[at(number)];
    if (model.demand.has_arrival_times) {
        return model.demand.inlets[at(number)].arrivals_s[static_cast<std::size_t>(inlet.entered_arrivals)];
    }
    if (model.demand.is_saturated(number)) return kBeforeStart_s;
    const double headway_s = model.demand.inlet_headway_s(number);
    if (!model.demand.is_evenly_spaced(number)) return inlet.last_entry_s + headway_s;
    return (static_cast<double>(inlet.entered) + first_entry_offset(model, number)) * headway_s;
}

}  // namespace

void insert_initial_queues(const Model& model, State& state) {
    if (!model.demand.starts_queued) return;
    reserve_initial_queues(model, state);
    for (int k = 0; k < static_cast<int>(model.demand.inlets.size()); ++k) {
        const int lane = model.demand.inlets[at(k)].lane;
        if (model.demand.inlets[at(k)].vehicles == 0) continue;
        draw_next_vehicle(model, state, k);
        const DriverTables& first_driver = model.driver_of(state.insertion.inlets[at(k)].next_policy).tables;
        double front_m = model.graph.lanes[at(lane)].stop_line_m - first_driver.stop.margin_m;
        while (front_m >= 0.0 && state.insertion.inlets[at(k)].entered < model.demand.inlets[at(k)].vehicles) {
            insert_at_inlet(model, state, k, {true, front_m, 0.0});
            const int last = state.blocks[at(lane)].last();
            draw_next_vehicle(model, state, k);
            const int next_policy = state.insertion.inlets[at(k)].next_policy;
            front_m -= state.vehicles.length_m[at(last)] + desired_gap_m(model, next_policy, 0.0);
        }
    }
    mark_detectors_passed(model, state);
}

void insert_vehicles(const Model& model, State& state) {
    InsertionState& insertion = state.insertion;
    const auto is_exhausted = [&](int k) {
        const DemandPlan::Inlet& planned = model.demand.inlets[at(k)];
        const InletState& inlet = insertion.inlets[at(k)];
        if (!model.demand.has_arrival_times) return inlet.entered >= planned.vehicles;
        return static_cast<std::size_t>(inlet.entered_arrivals) >= planned.arrivals_s.size();
    };
    const auto is_link = [&](int k) { return !model.connections_to.of(model.demand.inlets[at(k)].lane).empty(); };
    bool has_exhausted_link = false;
    for (const int k : insertion.open_inlets) {
        if (is_exhausted(k)) {
            has_exhausted_link = has_exhausted_link || is_link(k);
            continue;
        }
        draw_next_vehicle(model, state, k);
        const double now_s = model.time_s(state.tick + 1);
        const double due_s = next_entry_s(model, state, k);
        if (now_s < due_s) continue;
        const Entry entry = entry_at(model, state, k, insertion.inlets[at(k)].next_policy);
        if (!entry.is_possible) continue;
        insert_at_inlet(model, state, k, entry);
        ++insertion.inlets[at(k)].entered_arrivals;
        if (model.demand.forms_backlog(k)) insertion.inlets[at(k)].delays.add(now_s - due_s);
    }
    if (has_exhausted_link) {
        std::erase_if(insertion.open_inlets, [&](int k) { return is_exhausted(k) && is_link(k); });
    }
}

namespace {

// Returns the arrival time of a vehicle that has not entered yet. `k`: number of the vehicle among these, from 0.
double waiting_arrival_s(const Model& model, const State& state, int number, std::int64_t k) {
    const InletState& inlet = state.insertion.inlets[at(number)];
    if (model.demand.has_arrival_times) {
        return model.demand.inlets[at(number)].arrivals_s[static_cast<std::size_t>(inlet.entered_arrivals + k)];
    }
    return (static_cast<double>(inlet.entered + k) + first_entry_offset(model, number)) *
           model.demand.inlet_headway_s(number);
}

// Returns the number of vehicles of an inlet that have arrived but not entered.
std::int64_t inlet_backlog(const Model& model, const State& state, int number) {
    const DemandPlan::Inlet& planned = model.demand.inlets[at(number)];
    const InletState& inlet = state.insertion.inlets[at(number)];
    const double now_s = model.time_s(state.tick);
    if (!model.demand.forms_backlog(number)) return 0;
    if (model.demand.has_arrival_times) {
        const auto due = std::upper_bound(planned.arrivals_s.begin(), planned.arrivals_s.end(), now_s);
        return (due - planned.arrivals_s.begin()) - inlet.entered_arrivals;
    }
    const double arrived = now_s / model.demand.inlet_headway_s(number) + 1.0 - first_entry_offset(model, number);
    const std::int64_t due = std::min(static_cast<std::int64_t>(arrived), planned.vehicles);
    return std::max<std::int64_t>(due - inlet.entered, 0);
}

}  // namespace

std::int64_t insertion_backlog(const Model& model, const State& state) {
    std::int64_t backlog = 0;
    for (int k = 0; k < static_cast<int>(model.demand.inlets.size()); ++k) backlog += inlet_backlog(model, state, k);
    for (const std::vector<int>& trips : state.insertion.waiting_trips) {
        backlog += static_cast<std::int64_t>(trips.size());
    }
    return backlog;
}

DepartureDelays departure_delays(const Model& model, const State& state, int inlet) {
    DepartureDelays delays = state.insertion.inlets[at(inlet)].delays;
    const double now_s = model.time_s(state.tick);
    const std::int64_t backlog = inlet_backlog(model, state, inlet);
    for (std::int64_t k = 0; k < backlog; ++k) delays.add(now_s - waiting_arrival_s(model, state, inlet, k));
    return delays;
}

DepartureDelays departure_delays(const Model& model, const State& state) {
    DepartureDelays all;
    for (int k = 0; k < static_cast<int>(model.demand.inlets.size()); ++k) all.add(departure_delays(model, state, k));
    for (const DepartureDelays& delays : state.insertion.trip_delays) all.add(delays);
    for (const std::vector<int>& trips : state.insertion.waiting_trips) {
        for (const int trip : trips) all.add(model.time_s(state.tick) - model.demand.trips[at(trip)].depart_s);
    }
    return all;
}

}  // namespace stopline
