// Vehicles that change lanes along their route, enter and leave.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>

#include "base/random.h"
#include "sim/phases.h"

namespace stopline {

namespace {

constexpr double kFar_s = 1e9;
constexpr double kEntryHeadway_s = 2.0;  // of vehicles that waited outside

std::size_t at(int index) { return static_cast<std::size_t>(index); }

// Limit that the vehicle's route sets at the end of the lane it is on.
float end_speed(const State& state, std::span<const int> route, int index) {
    if (at(index) + 1 >= route.size()) return kNoLowerLimit_mps;
    const double here = state.plan.lane(route[at(index)]).limit_mps;
    const double next = state.plan.lane(route[at(index) + 1]).limit_mps;
    return next < here ? static_cast<float>(next) : kNoLowerLimit_mps;
}

void note(State& state, double time_s, int slot, int from, int to) {
    const VehicleArrays& v = state.vehicles;
    state.passages.push_back(
        {time_s, v.id[at(slot)], v.policy[at(slot)], from, to, static_cast<float>(v.speed_mps[at(slot)])});
}

// The lane does not serve the vehicle's way, and it could not change in time: it is put back behind the intersection, or stops at once.
void stray(const Model& model, State& state, int lane) {
    ++state.strayed;
    if (take_out(model, state, lane)) return;
    const std::size_t slot = at(state.blocks[at(lane)].first);
    state.vehicles.position_m[slot] = std::nextafter(state.plan.lane(lane).length_m, 0.0);
    state.vehicles.speed_mps[slot] = 0.0;
}

// Moves the first vehicle of a lane on along its route, or out of the network.
void pass_on(const Model& model, State& state, int lane) {
    VehicleArrays& v = state.vehicles;
    const double length_m = state.plan.lane(lane).length_m;
    const int next = v.next_lane[at(state.blocks[at(lane)].first)];
    const bool leaves = next < 0;
    const VehicleRecord& record = v.record[at(state.blocks[at(lane)].first)];
    if (leaves && record.trip >= 0 && !trip_ends(state, state.blocks[at(lane)].first)) return stray(model, state, lane);
    if (!leaves) make_room(state, next);
    const int slot = state.blocks[at(lane)].first;
    const int index = v.record[at(slot)].route_index + 1;
    const double line_m = leaves && record.trip >= 0 ? state.plan.lane(lane).stop_line_m : length_m;
    const double time_s = passing_time_s(model, state, slot, line_m);
    if (model.records_all) note(state, time_s, slot, lane, next);
    if (const int approach = model.graph.lanes[at(lane)].approach; approach >= 0 && !leaves) {
        ++state.turned[at(approach)][static_cast<std::size_t>(model.graph.lanes[at(next)].turn)];
    }
    if (leaves) {
        ++state.left;
        if (v.record[at(slot)].trip >= 0) note_trip(state, model.trips_end, slot, time_s);
    } else {
        const int target = append_slot(state, next);
        v.copy(slot, target);
        v.position_m[at(target)] -= length_m;
        v.record[at(target)].came_by = v.record[at(target)].came_from;
        v.record[at(target)].came_from = lane;
        put_on_route(state, target, index);
        choose_way_on(model, state, next, target);
    }
    remove_first(state, lane);
}

// The way of an inlet's k-th vehicle. `chose_lane`: it is on a lane from which it gets there.
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

// Between two intersections its rear is not in the first one.
Entry entry_of(const Model& model, const State& state, int inlet, int policy) {
    const int lane = model.demand.inlets[at(inlet)].lane;
    const double fastest_mps = std::min(model.demand.entry_speed_mps, model.graph.lanes[at(lane)].limit_mps);
    const LaneBlock& block = state.blocks[at(lane)];
    if (somebody_on_way_to(model, state, lane)) return {};
    const double least_m = model.leads_to[at(lane)].empty() ? 0.0 : model.vehicles[0].length_m;
    if (block.count == 0) return {true, least_m, fastest_mps};
    const VehicleArrays& v = state.vehicles;
    const std::size_t last = at(block.last());
    const double rear_m = v.position_m[last] - v.length_m[last];
    const double speed_mps = std::min(fastest_mps, v.speed_mps[last]);
    if (model.demand.is_saturated(inlet)) {
        const double position_m = rear_m - desired_gap_m(model, policy, speed_mps);
        return {position_m >= least_m, position_m, speed_mps};
    }
    const double headway_s = model.demand.is_even(inlet) ? kEntryHeadway_s : model.demand.entry_headway_s;
    const double room_m = desired_gap_m(model, policy, speed_mps) + speed_mps * headway_s * 0.5;
    return {rear_m - least_m >= room_m, least_m, speed_mps};
}

// Where it will turn at the next intersection but one, drawn as if it were there. `chose_lane`: it is on a lane from which it gets there.
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

}  // namespace

int put_on_lane(const Model& model, State& state, const Entering& entering) {
    const int slot = entering.behind_last ? append_slot(state, entering.lane)
                                          : insert_slot(model, state, entering.lane, entering.position_m);
    VehicleArrays& v = state.vehicles;
    const std::size_t i = at(slot);
    v.position_m[i] = entering.position_m;
    v.speed_mps[i] = entering.speed_mps;
    v.acceleration_mps2[i] = 0.0F;
    v.length_m[i] = static_cast<float>(entering.length_m);
    v.reset_powertrain(slot, model.vehicles[0], entering.speed_mps);
    v.leads[i] = 1.0F;
    v.standstill_gap_m[i] = static_cast<float>(model.policies[at(entering.policy)].settings.standstill_gap_m);
    v.policy[i] = entering.policy;
    v.type[i] = 0;
    v.id[i] = state.next_id++;
    v.record[i] = {};
    v.next_lane[i] = -1;
    v.record[i].route = entering.route;
    return slot;
}

void begin_to_drive(const Model& model, State& state, int lane, int slot) {
    VehicleArrays& v = state.vehicles;
    const std::size_t i = at(slot);
    const bool first = slot == state.blocks[at(lane)].first;
    v.stands_since[i] = static_cast<int>(state.tick);
    v.record[i].predecessor = first ? -1 : v.id[i - 1];
    const double gap_m = first ? 1e6 : v.position_m[i - 1] - v.length_m[i - 1] - v.position_m[i];
    v.reset_radar(slot, gap_m, first ? 0.0 : v.speed_mps[i] - v.speed_mps[i - 1]);
    v.reset_v2v(slot);
    state.resting[at(lane)].imposed = state.tick;
    ++state.entered;
    if (model.records_all) note(state, model.time_s(state.tick + 1), slot, -1, lane);
}

void follow_anew(State& state, int slot, const LaneBlock& block) {
    if (slot >= block.stop()) return;
    VehicleArrays& v = state.vehicles;
    const bool first = slot == block.first;
    v.record[at(slot)].predecessor = first ? -1 : v.id[at(slot - 1)];
    if (first) return;  // it looks beyond the lane in the next step
    v.leads[at(slot)] = 0.0F;
    const double rear_m = v.position_m[at(slot - 1)] - static_cast<double>(v.length_m[at(slot - 1)]);
    v.reset_radar(slot, rear_m - v.position_m[at(slot)], v.speed_mps[at(slot)] - v.speed_mps[at(slot - 1)]);
}

double desired_gap_m(const Model& model, int policy_number, double speed_mps) {
    const CompiledPolicy& policy = model.policies[at(policy_number)];
    double gap_m = 0.0;
    double slope_s = 0.0;
    policy.law->evaluate(policy.settings, {&speed_mps, 1}, {&gap_m, 1}, {&slope_s, 1});
    if (!model.meso) return gap_m;
    const Krauss& krauss = model.krauss[at(policy_number)];
    const double more_m = krauss.constant_distance ? gap_m - policy.settings.standstill_gap_m : 0.0;
    return krauss.equilibrium_gap_m(speed_mps) + more_m;
}

void put_on_route(State& state, int slot, int index) {
    VehicleArrays& v = state.vehicles;
    const std::span<const int> route = state.plan.route(v.record[at(slot)].route);
    v.record[at(slot)].route_index = index;
    v.next_lane[at(slot)] = at(index) + 1 < route.size() ? route[at(index) + 1] : -1;
    v.end_speed_mps[at(slot)] = end_speed(state, route, index);
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

namespace {

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

// When the front passed `line_m` within the last step, from the mean speed of the step (mesoscale mode: all at the new speed).
double passing_time_s(const Model& model, const State& state, int slot, double line_m) {
    const VehicleArrays& v = state.vehicles;
    const double speed_mps = v.speed_mps[at(slot)];
    const double speed_before = model.meso ? speed_mps : speed_mps - v.acceleration_mps2[at(slot)] * model.step_s;
    const double mean_mps = std::max(0.5 * (speed_before + speed_mps), 1e-6);
    const double since_s = (v.position_m[at(slot)] - line_m) / mean_mps;
    return model.time_s(state.tick + 1) - std::clamp(since_s, 0.0, model.step_s);
}

void transfer_vehicles(const Model& model, State& state) {
    for (NetworkPart& part : state.parts) {
        for (const int lane : part.ended) {
            const LaneBlock& block = state.blocks[at(lane)];
            while (block.count > 0 && has_ended(state, lane, block.first)) pass_on(model, state, lane);
        }
    }
}

namespace {

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

}  // namespace

namespace {

// Room for the queues at once: lane by lane, all others would be moved again and again.
void make_room_for_queues(const Model& model, State& state) {
    std::vector<int> expected(model.graph.lanes.size(), 0);
    for (const DemandPlan::Inlet& inlet : model.demand.inlets) {
        const double fit = model.graph.lanes[at(inlet.lane)].stop_line_m / shortest_vehicle_m(model) + 1.0;
        expected[at(inlet.lane)] = static_cast<int>(std::min(fit, static_cast<double>(inlet.vehicles)));
    }
    expect_vehicles(state, expected);
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

namespace {

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
