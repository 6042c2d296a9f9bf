// Vehicles that enter at inlets: saturated ones, at a rate, or queued before the first step. Those on trips: trips.cpp.
#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/arithmetic.h"
#include "base/random.h"
#include "sim/phases.h"

namespace stopline {

namespace {

constexpr double kFar_s = 1e9;
constexpr double kEntryHeadway_s = 2.0;  // of vehicles that waited outside

std::size_t at(int index) { return static_cast<std::size_t>(index); }

// Who enters next, drawn once for each vehicle.
void draw_next(const Model& model, State& state, int inlet) {
    InletState& entered = state.inlets[at(inlet)];
    if (entered.next_policy >= 0) return;
    entered.next_policy = model.demand.policy_of(inlet, entered.entered);
    entered.next_route = draw_route(model, state, inlet, entered.entered, false);
}

// How a vehicle would enter: whether there is room, where its front is, and how fast it is.
struct Entry {
    bool possible = false;
    double position_m = 0.0;
    double speed_mps = 0.0;
};

// Whether somebody is on a way that leads to the lane.
bool somebody_on_way_to(const Model& model, const State& state, int lane) {
    const std::vector<int>& ways = model.leads_to[at(lane)];
    return std::any_of(ways.begin(), ways.end(), [&](int way) { return state.blocks[at(way)].count > 0; });
}

// On a link without vehicles: behind the one beyond it.
Entry entry_on_empty_link(const Model& model, const State& state, int inlet, int policy, double fastest_mps) {
    const int lane = model.demand.inlets[at(inlet)].lane;
    const double front_m = model.vehicles[0].length_m;
    const double most_mps = std::min(fastest_mps, stops_from_mps(model, lane, front_m));
    const Ahead ahead =
        vehicle_ahead(state, lane, front_m, state.inlets[at(inlet)].next_route, 0, model.driver.cacc.radar_range_m);
    if (ahead.slot < 0) return {true, front_m, most_mps};
    const VehicleArrays& v = state.vehicles;
    const double ahead_mps = v.speed_mps[at(ahead.slot)];
    const double room_m = ahead.start_m + v.position_m[at(ahead.slot)] - v.length_m[at(ahead.slot)] - front_m;
    const double braking_m =
        0.5 * std::max(square(most_mps) - square(ahead_mps), 0.0) / model.driver.stop.deceleration_mps2;
    const bool far = room_m >= desired_gap_m(model, policy, most_mps) + braking_m;
    const double speed_mps = far ? most_mps : std::min(most_mps, ahead_mps);
    return {room_m >= desired_gap_m(model, policy, speed_mps), front_m, speed_mps};
}

// Between two intersections its rear is not in the first one.
Entry entry_of(const Model& model, const State& state, int inlet, int policy) {
    const int lane = model.demand.inlets[at(inlet)].lane;
    const double fastest_mps = std::min(model.demand.entry_speed_mps, model.graph.lanes[at(lane)].limit_mps);
    const LaneBlock& block = state.blocks[at(lane)];
    if (somebody_on_way_to(model, state, lane)) return {};
    const bool link = !model.leads_to[at(lane)].empty();
    if (block.count == 0 && link) return entry_on_empty_link(model, state, inlet, policy, fastest_mps);
    if (block.count == 0) return {true, 0.0, fastest_mps};
    const double least_m = link ? model.vehicles[0].length_m : 0.0;
    const VehicleArrays& v = state.vehicles;
    const std::size_t last = at(block.last());
    const double rear_m = v.position_m[last] - v.length_m[last];
    const double highest_mps = link ? std::min(fastest_mps, stops_from_mps(model, lane, least_m)) : fastest_mps;
    const double speed_mps = std::min(highest_mps, v.speed_mps[last]);
    if (model.demand.is_saturated(inlet)) {
        const double position_m = rear_m - desired_gap_m(model, policy, speed_mps);
        return {position_m >= least_m, position_m, speed_mps};
    }
    const double headway_s = model.demand.is_even(inlet) ? kEntryHeadway_s : model.demand.entry_headway_s;
    const double room_m = desired_gap_m(model, policy, speed_mps) + speed_mps * headway_s * 0.5;
    return {rear_m - least_m >= room_m, least_m, speed_mps};
}

// Takes over what the vehicle ahead does, as one of an endless platoon.
void drive_as(VehicleArrays& v, std::size_t i, std::size_t ahead) {
    v.acceleration_mps2[i] = v.acceleration_mps2[ahead];
    v.leads[i] = 0.0F;
    if (!v.has_powertrain()) return;
    v.request_mps2[i] = v.request_mps2[ahead];
    v.torque_Nm[i] = v.torque_Nm[ahead];
    v.brake_N[i] = v.brake_N[ahead];
    v.gear_time_s[i] = v.gear_time_s[ahead];
    v.lag_s[i] = v.lag_s[ahead];
    v.gear[i] = v.gear[ahead];
}

void enter(const Model& model, State& state, int inlet_index, const Entry& entry) {
    const DemandPlan::Inlet& inlet = model.demand.inlets[at(inlet_index)];
    InletState& entered = state.inlets[at(inlet_index)];
    const double length_m = model.vehicles[0].length_m;
    const int slot =
        put_on_lane(model, state,
                    {inlet.lane, entry.position_m, entry.speed_mps, length_m, entered.next_policy, entered.next_route});
    entered.next_policy = -1;
    VehicleArrays& v = state.vehicles;
    const std::size_t i = at(slot);
    const bool first = state.blocks[at(inlet.lane)].count == 1;
    if (model.demand.saturated && !first && v.speed_mps[i - 1] <= entry.speed_mps) drive_as(v, i, i - 1);
    take_way_of_lane(model, state, inlet.lane, slot);
    look_ahead(model, state, slot, true);
    begin_to_drive(model, state, inlet.lane, slot);
    ++entered.entered;
    entered.last_entry_s = model.time_s(state.tick + 1);
}

// Vehicles that stand beyond a counter have not passed it. Zones are another matter: what stands in them counts as entered.
void stand_beyond_counters(const Model& model, State& state) {
    for (std::size_t k = 0; k < model.detectors.size(); ++k) {
        const Detector& detector = model.detectors[k];
        if (detector.kind == Detector::Kind::zone) continue;
        const LaneBlock& block = state.blocks[at(detector.lane)];
        int& upstream = state.upstream[k];
        while (upstream > 0 && state.vehicles.position_m[at(block.stop() - upstream)] >= detector.position_m)
            --upstream;
    }
}

// Room for the queues at once: lane by lane, all others would be moved again and again.
void make_room_for_queues(const Model& model, State& state) {
    std::vector<int> expected(model.graph.lanes.size(), 0);
    for (const DemandPlan::Inlet& inlet : model.demand.inlets) {
        const double fit = model.graph.lanes[at(inlet.lane)].stop_line_m / shortest_vehicle_m(model) + 1.0;
        expected[at(inlet.lane)] = static_cast<int>(std::min(fit, static_cast<double>(inlet.vehicles)));
    }
    expect_vehicles(state, expected);
}

// Where vehicles come evenly: the first one comes after this share of the time between two of them.
double shift_of(const Model& model, int inlet) {
    return random_uniform(model.seed, static_cast<std::uint64_t>(inlet), 0, Purpose::insertion);
}

// Not before this does the next vehicle enter.
double next_entry_s(const Model& model, const State& state, int inlet) {
    if (model.demand.is_saturated(inlet)) return -kFar_s;
    const InletState& entered = state.inlets[at(inlet)];
    const double headway_s = model.demand.headway_at(inlet);
    if (!model.demand.is_even(inlet)) return entered.last_entry_s + headway_s;
    return (static_cast<double>(entered.entered) + shift_of(model, inlet)) * headway_s;
}

}  // namespace

void form_queues(const Model& model, State& state) {
    if (!model.demand.queued) return;
    make_room_for_queues(model, state);
    for (int k = 0; k < static_cast<int>(model.demand.inlets.size()); ++k) {
        const int lane = model.demand.inlets[at(k)].lane;
        double front_m = model.graph.lanes[at(lane)].stop_line_m - model.driver.stop.margin_m;
        while (front_m >= 0.0 && state.inlets[at(k)].entered < model.demand.inlets[at(k)].vehicles) {
            draw_next(model, state, k);
            enter(model, state, k, {true, front_m, 0.0});
            const VehicleArrays& v = state.vehicles;
            const int last = state.blocks[at(lane)].last();
            draw_next(model, state, k);
            front_m -= v.length_m[at(last)] + desired_gap_m(model, state.inlets[at(k)].next_policy, 0.0);
        }
    }
    stand_beyond_counters(model, state);
}

void insert_vehicles(const Model& model, State& state) {
    const auto is_dry = [&](int k) { return state.inlets[at(k)].entered >= model.demand.inlets[at(k)].vehicles; };
    const auto is_link = [&](int k) { return !model.leads_to[at(model.demand.inlets[at(k)].lane)].empty(); };
    bool some_dry = false;
    for (const int k : state.open_inlets) {
        if (is_dry(k)) {
            some_dry = some_dry || is_link(k);
            continue;
        }
        InletState& entered = state.inlets[at(k)];
        draw_next(model, state, k);
        if (model.time_s(state.tick + 1) < next_entry_s(model, state, k)) continue;
        const Entry entry = entry_of(model, state, k, entered.next_policy);
        if (entry.possible) enter(model, state, k, entry);
    }
    if (some_dry) std::erase_if(state.open_inlets, [&](int k) { return is_dry(k) && is_link(k); });
}

std::int64_t waiting_outside(const Model& model, const State& state) {
    std::int64_t waiting = 0;
    for (int k = 0; k < static_cast<int>(model.demand.inlets.size()); ++k) {
        if (model.demand.is_saturated(k) || !model.demand.is_even(k)) continue;
        const double come = model.time_s(state.tick) / model.demand.headway_at(k) + 1.0 - shift_of(model, k);
        const std::int64_t due = std::min(static_cast<std::int64_t>(come), model.demand.inlets[at(k)].vehicles);
        waiting += std::max<std::int64_t>(due - state.inlets[at(k)].entered, 0);
    }
    for (const std::vector<int>& trips : state.waiting_trips) waiting += static_cast<std::int64_t>(trips.size());
    return waiting;
}

}  // namespace stopline
