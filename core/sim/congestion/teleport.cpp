#include "sim/congestion/teleport.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/containers/index.h"
#include "sim/insertion/insert_vehicle.h"
#include "sim/lane_change/route_choice.h"
#include "sim/perception/approaching_vehicles.h"
#include "sim/perception/look_ahead.h"
#include "sim/perception/reset_leader.h"
#include "sim/state/delay_log.h"
#include "sim/state/lane_blocks.h"
#include "sim/state/queries/gap.h"
#include "sim/state/queries/stopping_distance.h"

namespace stopline {

namespace {

// Returns the exit lane of the intersection that a vehicle approaches or is crossing; -1: there is no intersection.
int exit_lane_ahead(const Model& model, const State& state, int lane, int slot) {
    const Route& route = model.graph.routes[at(state.vehicles.record[at(slot)].route)];
    if (route.lanes.size() < 2) return -1;  // the trip ends on this lane
    const bool is_upstream = model.graph.lanes[at(lane)].signal_group >= 0 || model.graph.lanes[at(lane)].origin >= 0;
    return is_upstream ? route.lanes.back() : -1;
}

void record_rule_use(const Model& model, State& state, RuleUse::Kind kind, int slot, int lane) {
    const VehicleArrays& v = state.vehicles;
    const double stopped_s = model.time_s(state.tick - v.stopped_since_tick[at(slot)]);
    state.congestion.delays.rule_uses.push_back({kind, model.time_s(state.tick), v.id[at(slot)], lane, -1, stopped_s});
}

}  // namespace

bool remove_for_teleport(const Model& model, State& state, int lane) {
    ensure_teleport_slot(state);
    CongestionState& congestion = state.congestion;
    LaneBlock& block = state.blocks[at(lane)];
    const int slot = block.first;
    const int target_lane = exit_lane_ahead(model, state, lane, slot);
    if (target_lane < 0 || congestion.teleporting.past_last() == congestion.teleporting.end) return false;
    // Each detector counts the vehicles upstream of it on the lane. The removed vehicle is taken out of this count, so
    // that the detector does not record it as a crossing.
    for (const int detector : state.detectors.on_lane.of(lane)) {
        int& upstream = state.detectors.upstream[at(detector)];
        upstream = std::min(upstream, block.count - 1);
    }
    record_rule_use(model, state, RuleUse::Kind::teleported, slot, lane);
    ++congestion.delays.teleported;
    state.vehicles.copy(slot, congestion.teleporting.past_last());
    ++congestion.teleporting.count;
    congestion.teleport_targets.push_back({target_lane, state.tick});
    remove_first(state, lane);
    return true;
}

namespace {

bool trip_ends_on_next_edge(const State& state, const Itinerary& itinerary) {
    return itinerary.has_trip() && state.plan.turn_of_trip(itinerary.trip, itinerary.trip_edge + 1) == Turn::none;
}

// Returns the highest safe speed, at most `wanted_mps`, with which a vehicle can be reinserted on an empty lane. A
// result below 0 means that the gap is too small. The leader is further downstream, but its rear can still be on the
// lane. Without a trip, the next route of the vehicle is not known yet. The leader is then a vehicle in the diverge
// area.
double speed_on_empty_lane_mps(const Model& model, const State& state, int lane, int slot, double front_m,
                               double wanted_mps) {
    const VehicleArrays& v = state.vehicles;
    const Itinerary itinerary = v.itinerary_of(at(slot));
    RoutePosition position{-1, 0, itinerary.trip, itinerary.trip_edge + 1};
    if (itinerary.has_trip()) {
        const Turn turn = state.plan.turn_of_trip(itinerary.trip, position.trip_edge);
        position.route = state.plan.adjacent(lane).turn_option(turn).route;
    }
    const LeaderAhead leader = leader_ahead(state, lane, front_m, position, model.common_driver().cacc.radar_range_m);
    if (leader.slot < 0) return wanted_mps;
    const double gap_m = rear_m(state, leader) - front_m;
    return safe_entry_speed_mps(model, v.policy[at(slot)], gap_m, v.speed_mps[at(leader.slot)], wanted_mps);
}

// Reinserts the k-th teleported vehicle at the start of its target lane, with the rear of the vehicle just past the
// intersection. Returns false if there is no room, or if a vehicle that approaches the lane could not stop behind the
// reinserted vehicle.
bool reinsert_teleported(const Model& model, State& state, int k) {
    VehicleArrays& v = state.vehicles;
    const int target_lane = state.congestion.teleport_targets[at(k)].lane;
    ensure_free_slot(state, target_lane);
    const int waiting = state.congestion.teleporting.first + k;
    const LaneBlock& block = state.blocks[at(target_lane)];
    const DriverPlan& driver = model.driver_of(v.policy[at(waiting)]);
    const Lane& lane = model.graph.lanes[at(target_lane)];
    const double length_m = v.length_m[at(waiting)];
    double front_m = length_m;
    double speed_mps = std::min(lane.limit_mps, model.vehicle_of(v.policy[at(waiting)]).maximum_speed_mps);
    // Only vehicles in imported networks have a trip. In these networks the vehicle can be longer than the target lane.
    // It is then reinserted only if its trip ends on the target lane, with its front at the stop line.
    const Itinerary itinerary = v.itinerary_of(at(waiting));
    if (itinerary.has_trip()) {
        if (length_m >= lane.stop_line_m && !trip_ends_on_next_edge(state, itinerary)) return false;
        front_m = std::min(length_m, lane.stop_line_m);
        const double to_line_m = lane.stop_line_m - front_m;
        speed_mps = std::min(speed_mps, std::sqrt(2.0 * driver.tables.stop.deceleration_mps2 * to_line_m));
    }
    if (block.count == 0) {
        speed_mps = speed_on_empty_lane_mps(model, state, target_lane, waiting, front_m, speed_mps);
        if (speed_mps < 0.0) return false;
    } else {
        const int last = block.last();
        const double room_m = rear_m(v, last) - front_m - static_cast<double>(v.standstill_gap_m[at(waiting)]);
        if (room_m < 0.0) return false;
        // Our choice: the vehicle enters so slowly that it closes up to its standstill gap in 2 s or more.
        constexpr double kApproach_1ps = 0.5;
        speed_mps = std::min(v.speed_mps[at(last)], kApproach_1ps * room_m);
    }
    if (!itinerary.has_trip()) {
        speed_mps = std::min(speed_mps, max_stoppable_speed_mps(model, driver, target_lane, front_m));
    }
    if (approaching_vehicle_cannot_stop(model, state, target_lane)) return false;
    const int slot = append_slot(state, target_lane);
    v.copy(waiting, slot);
    limit_to_maximum_speed(state, target_lane, slot);
    const auto i = at(slot);
    v.position_m[i] = front_m;
    v.speed_mps[i] = speed_mps;
    v.acceleration_mps2[i] = 0.0F;
    v.reset_powertrain(slot, model.vehicles[at(v.type_of(i))], speed_mps);
    v.is_platoon_leader[i] = 1.0F;
    v.record[i].previous_lane = v.record[i].second_previous_lane = v.record[i].accepted_gap_on = -1;
    initialise_sensors(v, slot, state.blocks[at(target_lane)].count == 1);
    const int route_index = static_cast<int>(model.graph.routes[at(v.record[i].route)].lanes.size()) - 1;
    set_route_index(model, state, slot, route_index);
    choose_next_route(model, state, target_lane, slot);
    record_rule_use(model, state, RuleUse::Kind::reinserted, slot, target_lane);
    v.stopped_since_tick[i] = static_cast<int>(state.tick);
    state.queues.standing[at(target_lane)].last_external_tick = static_cast<int>(state.tick);
    return true;
}

// Moves the target lane of a removed vehicle one intersection further downstream. Does nothing if no intersection
// follows or if the trip of the vehicle ends on the present target lane. Also does nothing until the vehicle has waited
// for as long as a drive along the present target lane would take.
void advance_target(const Model& model, State& state, int waiting, TeleportTarget& target) {
    const Lane& lane = model.graph.lanes[at(target.lane)];
    const double waiting_s = model.time_s(state.tick - target.waiting_since_tick);
    if (lane.signal_group < 0 || waiting_s < lane.length_m / lane.limit_mps) return;
    if (trip_ends_on_next_edge(state, state.vehicles.itinerary_of(at(waiting)))) return;
    choose_next_route(model, state, target.lane, waiting);
    target = {model.graph.routes[at(state.vehicles.record[at(waiting)].route)].lanes.back(), state.tick};
}

void reinsert_teleported_vehicles(const Model& model, State& state) {
    LaneBlock& teleporting = state.congestion.teleporting;
    std::vector<TeleportTarget>& targets = state.congestion.teleport_targets;
    for (int k = 0; k < teleporting.count;) {
        if (!reinsert_teleported(model, state, k)) {
            advance_target(model, state, teleporting.first + k, targets[at(k)]);
            ++k;
            continue;
        }
        const int freed = teleporting.first + k;
        state.vehicles.move(freed + 1, teleporting.past_last() - freed - 1, freed);
        targets.erase(targets.begin() + k);
        --teleporting.count;
        state.vehicles.clear_slot(teleporting.past_last());
    }
}

}  // namespace

void teleport_blocked_vehicles(const Model& model, State& state) {
    const RulesPlan& rules = model.rules;
    const bool is_needed = rules.teleport_ticks > 0 || state.congestion.teleporting.count > 0;
    if (!is_needed || state.tick % std::max<std::int64_t>(rules.watch_ticks, 1) != 0) return;
    reinsert_teleported_vehicles(model, state);
    if (rules.teleport_ticks == 0) return;
    for (const Partition& part : state.partitions) {
        for (const int lane : part.occupied) {
            const LaneBlock& block = state.blocks[at(lane)];
            if (block.count == 0) continue;
            const std::int64_t stopped_ticks = state.tick - state.vehicles.stopped_since_tick[at(block.first)];
            if (stopped_ticks >= rules.teleport_ticks) remove_for_teleport(model, state, lane);
        }
    }
}

}  // namespace stopline
