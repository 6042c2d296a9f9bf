// Vehicles that have stood for too long at the head of a lane are moved on past the intersection (HindranceRules).
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/arithmetic.h"
#include "sim/phases.h"

namespace stopline {

namespace {

constexpr double kReaction_s = 1.0;
constexpr double kApproach_m = 60.0;  // before an intersection within which vehicles may be about to come

std::size_t at(int index) { return static_cast<std::size_t>(index); }

// Where a vehicle on that lane is put back: behind the intersection that its route leads over; -1: it is behind it already.
int lane_beyond(const Model& model, const State& state, int lane, int slot) {
    const VehicleArrays& v = state.vehicles;
    const Route& route = model.graph.routes[at(v.record[at(slot)].route)];
    if (route.lanes.size() < 2) return -1;  // its trip ends here
    const bool before = model.graph.lanes[at(lane)].signal_group >= 0 || model.graph.lanes[at(lane)].origin >= 0;
    return before ? route.lanes.back() : -1;
}

void note(const Model& model, State& state, RuleUse::Kind kind, int slot, int lane) {
    const VehicleArrays& v = state.vehicles;
    const double stood_s = model.time_s(state.tick - v.stands_since[at(slot)]);
    state.hindrance.rules.push_back({kind, model.time_s(state.tick), v.id[at(slot)], lane, -1, stood_s});
}

}  // namespace

bool take_out(const Model& model, State& state, int lane) {
    make_room_in_limbo(state);
    LaneBlock& block = state.blocks[at(lane)];
    const int slot = block.first;
    const int beyond = lane_beyond(model, state, lane, slot);
    if (beyond < 0 || state.limbo.stop() == state.limbo.end) return false;
    // Detectors that it has not passed will not see it.
    for (const int detector : state.detectors_of[at(lane)]) {
        int& upstream = state.upstream[at(detector)];
        upstream = std::min(upstream, block.count - 1);
    }
    note(model, state, RuleUse::Kind::taken_out, slot, lane);
    ++state.hindrance.taken_out;
    state.vehicles.copy(slot, state.limbo.stop());
    ++state.limbo.count;
    state.removed.push_back({beyond, state.tick});
    remove_first(state, lane);
    return true;
}

bool somebody_comes(const Model& model, const State& state, int lane, double rear_m) {
    const VehicleArrays& v = state.vehicles;
    const double b = model.driver.cacc.deceleration_comfort_mps2;
    const auto too_near = [&](int slot, double distance_m) {
        const double speed = v.speed_mps[at(slot)];
        return speed * kReaction_s + 0.5 * square(speed) / b + v.standstill_gap_m[at(slot)] > distance_m;
    };
    for (const int inside : model.leads_to[at(lane)]) {
        const Lane& way = model.graph.lanes[at(inside)];
        const LaneBlock& inner = state.blocks[at(inside)];
        for (int slot = inner.first; slot < inner.stop(); ++slot) {
            if (too_near(slot, rear_m + way.length_m - v.position_m[at(slot)])) return true;
        }
        const LaneBlock& before = state.blocks[at(way.origin)];
        const double from_m = model.graph.lanes[at(way.origin)].length_m + way.length_m;
        for (int slot = before.first; slot < before.stop(); ++slot) {
            const double distance_m = from_m - v.position_m[at(slot)];
            if (distance_m > way.length_m + kApproach_m) break;
            if (v.next_lane[at(slot)] == inside && too_near(slot, rear_m + distance_m)) return true;
        }
    }
    return false;
}

namespace {

bool is_last_of_trip(const State& state, const VehicleRecord& record) {
    return record.trip >= 0 && state.plan.turn_of_trip(record.trip, record.leg + 1) == Turn::none;
}

// Whether one on a trip would keep its gap to those who are beyond the lane, or not wholly beyond it.
bool has_room_beyond(const Model& model, const State& state, const Removed& removed, int waiting, double front_m) {
    const VehicleArrays& v = state.vehicles;
    const VehicleRecord& record = v.record[at(waiting)];
    const Turn turn = state.plan.turn_of_trip(record.trip, record.leg + 1);
    const int way = state.plan.beside(removed.lane).way(turn).route;
    if (way < 0) return true;
    const Ahead ahead = vehicle_ahead(state, removed.lane, front_m, {way, 0, record.trip, record.leg + 1},
                                      model.driver.cacc.radar_range_m);
    if (ahead.slot < 0) return true;
    const double rear_m =
        ahead.start_m + v.position_m[at(ahead.slot)] - static_cast<double>(v.length_m[at(ahead.slot)]);
    return rear_m - front_m >= static_cast<double>(v.standstill_gap_m[at(waiting)]);
}

// Puts the k-th vehicle that was taken out at the start of its lane, its rear just behind the intersection. False: there is no room.
bool put_back(const Model& model, State& state, int k) {
    VehicleArrays& v = state.vehicles;
    const Removed removed = state.removed[at(k)];
    make_room(state, removed.lane);
    const int waiting = state.limbo.first + k;
    const LaneBlock& block = state.blocks[at(removed.lane)];
    const Lane& lane = model.graph.lanes[at(removed.lane)];
    const double length_m = v.length_m[at(waiting)];
    double front_m = length_m;
    double speed_mps = lane.limit_mps;
    if (v.record[at(waiting)].trip >= 0) {  // edges of imported networks may be of any length
        if (length_m >= lane.stop_line_m && !is_last_of_trip(state, v.record[at(waiting)])) return false;
        front_m = std::min(length_m, lane.stop_line_m);
        const double to_line_m = lane.stop_line_m - front_m;
        speed_mps = std::min(speed_mps, std::sqrt(2.0 * model.driver.stop.deceleration_mps2 * to_line_m));
        if (block.count == 0 && !has_room_beyond(model, state, removed, waiting, front_m)) return false;
    }
    const double gap_m = v.standstill_gap_m[at(waiting)];
    if (block.count > 0) {
        const int last = block.last();
        const double room_m = v.position_m[at(last)] - static_cast<double>(v.length_m[at(last)]) - front_m - gap_m;
        if (room_m < 0.0) return false;
        speed_mps = std::min(v.speed_mps[at(last)], 0.5 * room_m);
    }
    if (v.record[at(waiting)].trip < 0) speed_mps = std::min(speed_mps, stops_from_mps(model, removed.lane, front_m));
    if (somebody_comes(model, state, removed.lane)) return false;
    const int slot = append_slot(state, removed.lane);
    v.copy(waiting, slot);
    const auto i = at(slot);
    const bool first = state.blocks[at(removed.lane)].count == 1;
    v.position_m[i] = front_m;
    v.speed_mps[i] = speed_mps;
    v.acceleration_mps2[i] = 0.0F;
    v.reset_powertrain(slot, model.vehicles[at(v.type[i])], speed_mps);
    v.leads[i] = 1.0F;
    v.record[i].came_from = v.record[i].came_by = v.record[i].cleared_for = -1;
    v.record[i].predecessor = first ? -1 : v.id[i - 1];
    const double ahead_m = first ? 1e6 : v.position_m[i - 1] - static_cast<double>(v.length_m[i - 1]) - front_m;
    v.reset_radar(slot, ahead_m, first ? 0.0 : speed_mps - v.speed_mps[i - 1]);
    v.reset_v2v(slot);
    const int index = static_cast<int>(model.graph.routes[at(v.record[i].route)].lanes.size()) - 1;
    put_on_route(state, slot, index);
    choose_way_on(model, state, removed.lane, slot);
    note(model, state, RuleUse::Kind::put_back, slot, removed.lane);
    v.stands_since[i] = static_cast<int>(state.tick);
    state.resting[at(removed.lane)].imposed = state.tick;
    return true;
}

// A lane that stays full for as long as driving along it takes is behind the vehicle too.
void look_further(const Model& model, State& state, int waiting, Removed& removed) {
    const Lane& lane = model.graph.lanes[at(removed.lane)];
    if (lane.signal_group < 0 || model.time_s(state.tick - removed.since) < lane.length_m / lane.limit_mps) return;
    const VehicleRecord& record = state.vehicles.record[at(waiting)];
    if (is_last_of_trip(state, record)) return;
    choose_way_on(model, state, removed.lane, waiting);
    removed = {model.graph.routes[at(state.vehicles.record[at(waiting)].route)].lanes.back(), state.tick};
}

}  // namespace

void move_blocked_on(const Model& model, State& state) {
    const RulesPlan& rules = model.rules;
    const bool has_some = rules.teleport_ticks > 0 || state.limbo.count > 0;
    if (!has_some || state.tick % std::max<std::int64_t>(rules.watch_ticks, 1) != 0) return;
    LaneBlock& limbo = state.limbo;
    for (int k = 0; k < limbo.count;) {
        if (!put_back(model, state, k)) {
            look_further(model, state, limbo.first + k, state.removed[at(k)]);
            ++k;
            continue;
        }
        const int gone = limbo.first + k;
        state.vehicles.move(gone + 1, limbo.stop() - gone - 1, gone);
        state.removed.erase(state.removed.begin() + k);
        --limbo.count;
        state.vehicles.forget(limbo.stop());
    }
    if (rules.teleport_ticks == 0) return;
    for (const NetworkPart& part : state.parts) {
        for (const int lane : part.occupied) {
            const LaneBlock& block = state.blocks[at(lane)];
            if (block.count == 0) continue;
            const std::int64_t stood = state.tick - state.vehicles.stands_since[at(block.first)];
            if (stood >= rules.teleport_ticks) take_out(model, state, lane);
        }
    }
}

}  // namespace stopline
