// The scalar part of a step, at the heads of lanes: who stops at the line, and what the first vehicle sees beyond it.
#include <algorithm>
#include <array>
#include <cmath>

#include "base/arithmetic.h"
#include "sim/meso_dynamics.h"
#include "sim/phases.h"

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

// Whether braking with `deceleration` stops the vehicle before the line. The brake's lag and the time in which the request changes
// from the present acceleration to it cost a stretch at the present speed, and the acceleration goes on for as long.
bool can_stop(const Model& model, const VehicleArrays& v, int slot, double line_m, double deceleration_mps2) {
    const double speed = v.speed_mps[at(slot)];
    const double lag_s = model.vehicles[at(v.type[at(slot)])].brake_lag_s;
    const double now_mps2 = std::max(static_cast<double>(v.acceleration_mps2[at(slot)]), 0.0);
    const double late_s = lag_s + 0.5 * (now_mps2 + deceleration_mps2) / model.driver.cacc.jerk_down_mps3;
    const double room_m = line_m - v.position_m[at(slot)] - speed * late_s;
    return square(speed + now_mps2 * late_s) <= 2.0 * deceleration_mps2 * room_m;
}

int slot_of(const VehicleArrays& v, const LaneBlock& block, int id) {
    for (int slot = block.first; slot < block.stop(); ++slot) {
        if (v.id[at(slot)] == id) return slot;
    }
    return -1;
}

// The first vehicle that can stop does. On yellow it is enough to brake as hard as drivers accept; on red all that the
// brakes give is used.
int choose_stopper(const Model& model, const State& state, const LaneBlock& block, double line_m, Light light) {
    const double deceleration = light == Light::yellow ? model.driver.stop.decision_deceleration_mps2
                                                       : model.driver.cacc.deceleration_emergency_mps2;
    for (int slot = block.first; slot < block.stop(); ++slot) {
        if (can_stop(model, state.vehicles, slot, line_m, deceleration)) return slot;
    }
    return -1;
}

bool line_is_open(const Model& model, const State& state, const Lane& lane, const StopLineState& line) {
    if (state.lights[at(lane.signal_group)] != Light::green) return false;
    // The vehicle that waits at the line hesitates at the start of green.
    return line.stopper < 0 ||
           state.tick >= model.signals[at(lane.signal_group)].since(state.tick) + model.hesitation_ticks;
}

constexpr double kStands_mps = 0.1;

// Room that one exit of an intersection still has, and who stands across the way to it.
struct ExitRoom {
    int inside = -1;      // lane that leads to it
    double room_m = 1e9;  // before the last vehicle that stands within sight, less what those on their way there need
    int standing = -1;    // its slot
    int across = -1;
};

double needs_m(const VehicleArrays& v, int slot) {
    return static_cast<double>(v.length_m[at(slot)]) + static_cast<double>(v.standstill_gap_m[at(slot)]);
}

ExitRoom look_into_exit(const Model& model, const State& state, int inside) {
    const VehicleArrays& v = state.vehicles;
    const int exit = model.graph.lanes[at(inside)].next[0];
    const LaneBlock& block = state.blocks[at(exit)];
    ExitRoom room;
    room.inside = inside;
    double moving_m = 0.0;
    for (int slot = block.last(); slot >= block.first; --slot) {
        const double rear_m = v.position_m[at(slot)] - static_cast<double>(v.length_m[at(slot)]);
        if (rear_m > model.rules.sight_m) return room;
        if (v.speed_mps[at(slot)] < kStands_mps) {
            room.standing = slot;
            room.room_m = rear_m - moving_m;
            break;
        }
        moving_m += needs_m(v, slot);
    }
    if (room.standing < 0) return room;
    for (const int other : model.leads_to[at(exit)]) {
        const LaneBlock& inner = state.blocks[at(other)];
        for (int slot = inner.first; slot < inner.stop(); ++slot) room.room_m -= needs_m(v, slot);
    }
    return room;
}

// The slot of a vehicle from the streets that cross which stands across this way, where it may not be passed; -1: none.
int stands_across(const Model& model, const State& state, int inside) {
    const VehicleArrays& v = state.vehicles;
    const std::int64_t patience = model.rules.pass_blocker_ticks;
    for (const Conflict& c : model.graph.conflicts[at(inside)]) {
        if (c.yields || c.other_yields) continue;
        for (const Insider& w : state.insiders[at(c.other)]) {
            if (w.front_m <= c.other_from_m || w.rear_m >= c.other_to_m || v.speed_mps[at(w.slot)] >= kStands_mps)
                continue;
            if (patience > 0 && state.tick - v.stands_since[at(w.slot)] >= patience) continue;
            return w.slot;
        }
    }
    return -1;
}

// The first vehicle that finds no room in its exit, or somebody across its way, and can stop comfortably; -1: none.
int keep_clear(const Model& model, State& state, int index) {
    constexpr std::size_t kMostWays = 8;
    constexpr double kDecides_m = 80.0;  // before the stop line, at most
    const VehicleArrays& v = state.vehicles;
    const Lane& lane = model.graph.lanes[at(index)];
    const LaneBlock& block = state.blocks[at(index)];
    std::array<ExitRoom, kMostWays> ways;
    std::size_t known = 0;
    for (int slot = block.first; slot < block.stop(); ++slot) {
        if (v.position_m[at(slot)] < lane.stop_line_m - kDecides_m) break;
        const int inside = v.next_lane[at(slot)];
        std::size_t way = 0;
        while (way < known && ways[way].inside != inside) ++way;
        if (way == known) {
            if (known == kMostWays) break;
            ways[known] = look_into_exit(model, state, inside);
            ways[known++].across = stands_across(model, state, inside);
        }
        ExitRoom& room = ways[way];
        room.room_m -= needs_m(v, slot);
        if ((room.room_m >= 0.0 && room.across < 0) || v.position_m[at(slot)] > lane.stop_line_m) continue;
        if (!can_stop(model, v, slot, lane.stop_line_m, model.driver.cacc.deceleration_comfort_mps2)) continue;
        state.kept_out[at(index)] = room.across >= 0 ? KeptOut{room.across, false} : KeptOut{room.standing, true};
        return slot;
    }
    return -1;
}

}  // namespace

void read_signals(const Model& model, State& state) {
    for (std::size_t group = 0; group < model.signals.size(); ++group) {
        state.lights[group] = model.signals[group].light(state.tick);
    }
}

void find_occupied_lanes(const Model& model, State& state) {
    state.occupied.clear();
    for (int lane = 0; lane < static_cast<int>(model.graph.lanes.size()); ++lane) {
        if (state.blocks[at(lane)].count > 0) state.occupied.push_back(lane);
    }
}

void decide_stops(const Model& model, State& state) {
    for (const int index : state.occupied) {
        const Lane& lane = model.graph.lanes[at(index)];
        state.kept_out[at(index)] = {};
        if (lane.signal_group < 0) continue;
        StopLineState& line = state.stop_lines[at(index)];
        const LaneBlock& block = state.blocks[at(index)];
        int stop_slot = -1;
        if (line_is_open(model, state, lane, line)) {
            line.stopper = -1;
            if (model.rules.keep_clear) stop_slot = keep_clear(model, state, index);
        } else {
            if (line.stopper >= 0) stop_slot = slot_of(state.vehicles, block, line.stopper);
            if (stop_slot < 0) {
                stop_slot = choose_stopper(model, state, block, lane.stop_line_m, state.lights[at(lane.signal_group)]);
            }
            line.stopper = stop_slot < 0 ? -1 : state.vehicles.id[at(stop_slot)];
            // It leads what follows it through the next green.
            if (stop_slot >= 0) {
                state.vehicles.leads[at(stop_slot)] = 1.0F;
                // One that came to stand a little beyond the line sets out when the next green lets it.
                state.vehicles.inside_since[at(stop_slot)] = static_cast<int>(state.tick);
            }
        }
        state.stop_slot[at(index)] = stop_slot;
    }
}

namespace {

constexpr double kFar_m = 1e9;

// Where movements part: the vehicle on any of them whose rear is still on the shared stretch, if any.
Ahead still_shared(const Model& model, const State& state, int lane, double& rear_m) {
    const VehicleArrays& v = state.vehicles;
    const double end_m = model.graph.lanes[at(lane)].length_m;
    Ahead found;
    for (const int next : model.graph.lanes[at(lane)].next) {
        const LaneBlock& block = state.blocks[at(next)];
        if (block.count == 0) continue;
        const double beyond_m = v.position_m[at(block.last())] - v.length_m[at(block.last())];
        if (beyond_m >= 0.0 || end_m + beyond_m >= rear_m) continue;
        rear_m = end_m + beyond_m;
        found = {block.last(), end_m};
    }
    return found;
}

}  // namespace

Ahead vehicle_ahead(const Model& model, const State& state, int lane, int slot, double range_m) {
    const VehicleArrays& v = state.vehicles;
    const Route& route = model.graph.routes[at(v.route[at(slot)])];
    double start_m = model.graph.lanes[at(lane)].length_m;
    Ahead beside;
    double beside_rear_m = kFar_m;
    if (model.graph.lanes[at(lane)].next.size() > 1) beside = still_shared(model, state, lane, beside_rear_m);
    for (std::size_t k = at(v.route_index[at(slot)]) + 1; k < route.lanes.size(); ++k) {
        if (start_m - v.position_m[at(slot)] > range_m) break;
        const LaneBlock& block = state.blocks[at(route.lanes[k])];
        if (block.count > 0) {
            const double rear_m = start_m + v.position_m[at(block.last())] - v.length_m[at(block.last())];
            return rear_m <= beside_rear_m ? Ahead{block.last(), start_m} : beside;
        }
        start_m += model.graph.lanes[at(route.lanes[k])].length_m;
    }
    return beside;
}

namespace {

// Fetches what will be read and written at a lane's head, and at its end by the lane before.
void prefetch_ends(const State& state, int lane) {
    const VehicleArrays& v = state.vehicles;
    const LaneBlock& block = state.blocks[at(lane)];
    for (const int slot : {block.first - 1, block.last()}) {
        __builtin_prefetch(&v.position_m[at(slot)]);
        __builtin_prefetch(&v.speed_mps[at(slot)]);
        __builtin_prefetch(&v.length_m[at(slot)]);
        for (const std::size_t row : {state.v2v.late, state.v2v.later}) {
            __builtin_prefetch(&v.v2v_acceleration_mps2[row + at(slot)]);
            __builtin_prefetch(&v.v2v_request_mps2[row + at(slot)]);
            __builtin_prefetch(&v.v2v_rate_1ps[row + at(slot)]);
        }
    }
    __builtin_prefetch(&v.predecessor[at(block.first)]);
    __builtin_prefetch(&v.route[at(block.first)]);
    __builtin_prefetch(&v.route_index[at(block.first)]);
    __builtin_prefetch(&v.id[at(block.last())]);
}

}  // namespace

void look_beyond_lanes(const Model& model, State& state) {
    constexpr double kNothing_m = 1e6;
    constexpr std::size_t kLanesAhead = 4;
    const bool prefetch = state.outgrows_cache();
    VehicleArrays& v = state.vehicles;
    for (std::size_t k = 0; k < state.occupied.size(); ++k) {
        const int lane = state.occupied[k];
        if (prefetch && k + kLanesAhead < state.occupied.size()) {
            prefetch_ends(state, state.occupied[k + kLanesAhead]);
        }
        const int head = state.blocks[at(lane)].first;
        const std::size_t sentinel = at(head - 1);
        const Ahead ahead = vehicle_ahead(model, state, lane, head, model.driver.cacc.radar_range_m);
        const bool seen = ahead.slot >= 0;
        const std::size_t other = at(seen ? ahead.slot : head);
        v.position_m[sentinel] = seen ? ahead.start_m + v.position_m[other] : kNothing_m;
        v.speed_mps[sentinel] = v.speed_mps[other];
        v.length_m[sentinel] = v.length_m[other];
        v.acceleration_mps2[sentinel] = seen ? v.acceleration_mps2[other] : 0.0F;
        const double rear_m = v.position_m[sentinel] - v.length_m[sentinel];
        state.violations.overlaps += static_cast<std::int64_t>(seen && rear_m < v.position_m[at(head)]);
        for (const std::size_t row : {state.v2v.late, state.v2v.later}) {
            const std::size_t to = row + sentinel;
            const std::size_t from = row + other;
            v.v2v_acceleration_mps2[to] = seen ? v.v2v_acceleration_mps2[from] : 0.0F;
            v.v2v_request_mps2[to] = seen ? v.v2v_request_mps2[from] : 0.0F;
            v.v2v_rate_1ps[to] = seen ? v.v2v_rate_1ps[from] : 1.0F;
        }
        const int id = seen ? v.id[other] : -1;
        if (v.predecessor[at(head)] == id) continue;
        // A new target: its first radar measurement stands for the past too.
        v.predecessor[at(head)] = id;
        v.leads[at(head)] = 1.0F;
        const double gap_m = rear_m - v.position_m[at(head)];
        v.reset_radar(head, gap_m, v.speed_mps[at(head)] - v.speed_mps[sentinel]);
    }
}

LaneStep lane_step(const Model& model, const State& state, int lane) {
    const LaneBlock& block = state.blocks[at(lane)];
    const Lane& road = model.graph.lanes[at(lane)];
    LaneStep step;
    step.begin = block.first;
    step.stop = block.stop();
    step.turn_m = road.signal_group >= 0 ? road.stop_line_m : road.length_m;
    step.limit_mps = road.limit_mps;
    step.sine = state.sine[at(lane)];
    const auto impose = [&](int slot, double place_m) {
        const double room_m = place_m - state.vehicles.position_m[at(slot)];
        const double asks = model.meso ? stopping_speed_mps(model, state.vehicles, slot, room_m)
                                       : stop_at_line_mps2(model.driver, state.vehicles.speed_mps[at(slot)], room_m);
        step.imposed[at(step.imposed_count++)] = {slot, asks};
    };
    const int stopper = state.stop_slot[at(lane)];
    if (stopper >= 0) impose(stopper, road.stop_line_m - model.driver.stop.margin_m);
    const Holds& holds = state.holds[at(lane)];
    for (int k = 0; k < holds.count; ++k) impose(holds.each[at(k)].slot, holds.each[at(k)].place_m);
    if (model.meso) {
        step.limit_mps *= model.speed_factor;
        if (state.vehicles.predecessor[at(step.begin)] < 0) step.leader_mps = model.leader_share * step.limit_mps;
    }
    return step;
}

}  // namespace stopline
