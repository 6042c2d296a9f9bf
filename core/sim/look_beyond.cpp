// What the first vehicle of a lane sees beyond it.
#include <algorithm>
#include <cmath>

#include "sim/phases.h"

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

constexpr double kFar_m = 1e9;

// Where movements part: the vehicle on any of them whose rear is still on the shared stretch, if any.
Ahead still_shared(const State& state, int lane, double& rear_m) {
    const VehicleArrays& v = state.vehicles;
    const double end_m = state.plan.lane(lane).length_m;
    Ahead found;
    for (const int next : state.plan.next(lane)) {
        const LaneBlock& block = state.blocks[at(next)];
        if (block.count == 0) continue;
        const double beyond_m = v.position_m[at(block.last())] - v.length_m[at(block.last())];
        if (beyond_m >= 0.0 || end_m + beyond_m >= rear_m) continue;
        rear_m = end_m + beyond_m;
        found = {block.last(), end_m};
    }
    return found;
}

// Beyond the route, which ends on the next edge: on edges that are shorter than the range. Nobody is on the route.
Ahead ahead_on_trip(const State& state, int lane, double position_m, const OnTrip& on_trip, double range_m) {
    const std::span<const int> route = state.plan.route(on_trip.route);
    double start_m = 0.0;  // of `at_lane`, from the start of the vehicle's own
    int at_lane = lane;
    for (std::size_t k = at(on_trip.route_index) + 1; k < route.size(); ++k) {
        start_m += state.plan.lane(at_lane).length_m;
        at_lane = route[k];
    }
    for (int leg = on_trip.leg + 1;; ++leg) {
        const Turn turn = state.plan.turn_of_trip(on_trip.trip, leg);
        const int way = turn == Turn::none ? -1 : state.plan.beside(at_lane).way(turn).route;
        double rear_m = kFar_m;
        Ahead shared = still_shared(state, at_lane, rear_m);
        if (shared.slot >= 0) return {shared.slot, start_m + shared.start_m};
        if (way < 0) return {};
        const std::span<const int> on = state.plan.route(way);
        for (std::size_t k = 1; k < on.size(); ++k) {
            start_m += state.plan.lane(at_lane).length_m;
            at_lane = on[k];
            if (start_m - position_m > range_m) return {};
            const LaneBlock& block = state.blocks[at(at_lane)];
            if (block.count > 0) return {block.last(), start_m};
        }
    }
}

}  // namespace

Ahead vehicle_ahead(const State& state, int lane, int slot, double range_m) {
    const VehicleRecord& record = state.vehicles.record[at(slot)];
    if (record.next_lane < 0) {  // it leaves, or waits for a gap: it sees who still reaches back
        double rear_m = kFar_m;
        return still_shared(state, lane, rear_m);
    }
    const double position_m = state.vehicles.position_m[at(slot)];
    return vehicle_ahead(state, lane, position_m, {record.route, record.route_index, record.trip, record.leg}, range_m);
}

Ahead vehicle_ahead(const State& state, int lane, double position_m, const OnTrip& on_trip, double range_m) {
    const Ahead seen = vehicle_ahead(state, lane, position_m, on_trip.route, on_trip.route_index, range_m);
    if (seen.slot >= 0 || on_trip.trip < 0) return seen;
    return ahead_on_trip(state, lane, position_m, on_trip, range_m);
}

Ahead vehicle_ahead(const State& state, int lane, double position_m, int route_number, int index, double range_m) {
    const VehicleArrays& v = state.vehicles;
    const LanePlan& here = state.plan.lane(lane);
    double start_m = here.length_m;
    if (!here.branches && start_m - position_m > range_m) return {};
    Ahead beside;
    double beside_rear_m = kFar_m;
    const std::span<const int> route = state.plan.route(route_number);
    const bool ends_here = at(index) + 1 == route.size();  // where others go on
    if (here.branches || ends_here) beside = still_shared(state, lane, beside_rear_m);
    for (std::size_t k = at(index) + 1; k < route.size(); ++k) {
        if (start_m - position_m > range_m) break;
        const LaneBlock& block = state.blocks[at(route[k])];
        if (block.count > 0) {
            const double rear_m = start_m + v.position_m[at(block.last())] - v.length_m[at(block.last())];
            return rear_m <= beside_rear_m ? Ahead{block.last(), start_m} : beside;
        }
        start_m += state.plan.lane(route[k]).length_m;
    }
    return beside;
}

namespace {

// What the sentinel says by V2V: what the vehicle ahead does, or nothing.
void hear(State& state, std::size_t sentinel, std::size_t ahead, bool seen) {
    VehicleArrays& v = state.vehicles;
    for (const std::size_t row : {state.v2v.late, state.v2v.later}) {
        const std::size_t to = row + sentinel;
        const std::size_t from = row + ahead;
        v.v2v_acceleration_mps2[to] = seen ? v.v2v_acceleration_mps2[from] : 0.0F;
        v.v2v_request_mps2[to] = seen ? v.v2v_request_mps2[from] : 0.0F;
        v.v2v_rate_1ps[to] = seen ? v.v2v_rate_1ps[from] : 1.0F;
    }
}

}  // namespace

namespace {

// Whether the rear of the vehicle ahead is still on a way that joins that of this one further on. Whether they touch before is a matter of
// conflict areas (right_of_way.cpp).
bool comes_by_another_way(const State& state, int slot, int ahead) {
    const VehicleArrays& v = state.vehicles;
    const VehicleRecord& other = v.record[at(ahead)];
    double rear_m = v.position_m[at(ahead)] - static_cast<double>(v.length_m[at(ahead)]);
    if (rear_m >= 0.0) return false;
    const std::span<const int> route = state.plan.route(v.record[at(slot)].route);
    const auto is_own = [&](int lane) { return std::find(route.begin(), route.end(), lane) != route.end(); };
    if (other.came_from >= 0 && !is_own(other.came_from)) return true;
    // Over an edge that is shorter than the vehicle.
    if (other.came_from >= 0) rear_m += state.plan.lane(other.came_from).length_m;
    return rear_m < 0.0 && other.came_by >= 0 && !is_own(other.came_by);
}

}  // namespace

void look_beyond_lanes(const Model& model, State& state, NetworkPart& part) {
    constexpr double kNothing_m = 1e6;
    constexpr double kTouch_m = 1e-4;  // against rounding
    VehicleArrays& v = state.vehicles;
    for (const int lane : part.awake) {
        const int head = state.blocks[at(lane)].first;
        const std::size_t sentinel = at(head - 1);
        const Ahead ahead = vehicle_ahead(state, lane, head, model.driver.cacc.radar_range_m);
        const bool seen = ahead.slot >= 0;
        const std::size_t other = at(seen ? ahead.slot : head);
        v.position_m[sentinel] = seen ? ahead.start_m + v.position_m[other] : kNothing_m;
        v.speed_mps[sentinel] = v.speed_mps[other];
        v.length_m[sentinel] = v.length_m[other];
        v.acceleration_mps2[sentinel] = seen ? v.acceleration_mps2[other] : 0.0F;
        if (const double reach_m = v.position_m[sentinel] - v.position_m[at(head)];
            seen && reach_m < v.length_m[sentinel] && comes_by_another_way(state, head, ahead.slot)) {
            v.length_m[sentinel] = static_cast<float>(std::max(reach_m - kTouch_m, 0.0));
        }
        const double rear_m = v.position_m[sentinel] - v.length_m[sentinel];
        // The mesoscale mode counts with all others (meso_kernels.h).
        if (!model.meso) part.violations.overlaps += static_cast<std::int64_t>(seen && rear_m < v.position_m[at(head)]);
        if (v.has_powertrain()) hear(state, sentinel, other, seen);
        const int id = seen ? v.id[other] : -1;
        if (v.record[at(head)].predecessor == id) continue;
        // A new target: its first radar measurement stands for the past too.
        v.record[at(head)].predecessor = id;
        v.leads[at(head)] = 1.0F;
        const double gap_m = rear_m - v.position_m[at(head)];
        v.reset_radar(head, gap_m, v.speed_mps[at(head)] - v.speed_mps[sentinel]);
    }
}

}  // namespace stopline
