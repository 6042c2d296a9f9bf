// Giving way inside intersections: who is there, who must wait before which conflict area. The state at the beginning of the
// step decides. A lane inside an intersection has at most one vehicle that waits by itself; those behind follow it.
//
// A vehicle may go into a conflict area
//   - when no vehicle of the other lane is in it, nor on its way to it after it has accepted a gap;
//   - where it has to give way: when the next vehicle with priority is further away than the critical gap and the time it
//     takes to get to the area; this is decided once, for all areas where it has to give way;
//   - where neither has priority (movements of different signal groups): when no vehicle that passed its stop line
//     before is still to come.
#include <algorithm>
#include <cmath>

#include "base/arithmetic.h"
#include "sim/phases.h"

namespace stopline {

namespace {

constexpr double kNever_s = 1e9;
constexpr double kStanding_mps = 1.0;
constexpr double kCloseBehind_m = 6.0;
constexpr double kSeen_m = 20.0;

std::size_t at(int index) { return static_cast<std::size_t>(index); }

Insider insider(const VehicleArrays& v, int slot, double offset_m) {
    const double front_m = v.position_m[at(slot)] + offset_m;
    return {slot, front_m, front_m - v.length_m[at(slot)], v.inside_since[at(slot)]};
}

// Stands and waits for others itself: it will not come before they have gone, and they may be waiting for who asks.
bool held(const State& state, int slot) {
    const VehicleArrays& v = state.vehicles;
    return v.held_at[at(slot)] >= state.tick - 1 && v.speed_mps[at(slot)] < kStanding_mps;
}

// From the front: rears that reach back from the exit lane, the lane itself, fronts past the stop line on the origin.
void list_insiders(const Model& model, const State& state, int lane, std::vector<Insider>& insiders) {
    const VehicleArrays& v = state.vehicles;
    const Lane& road = model.graph.lanes[at(lane)];
    insiders.clear();
    const LaneBlock& exit = state.blocks[at(road.next[0])];
    const auto reaches_back = [&](int slot) { return v.position_m[at(slot)] < v.length_m[at(slot)]; };
    if (exit.count > 0 && reaches_back(exit.last())) {
        for (int slot = std::max(exit.first, exit.stop() - 2); slot < exit.stop(); ++slot) {
            if (v.came_from[at(slot)] != lane || !reaches_back(slot)) continue;
            insiders.push_back(insider(v, slot, road.length_m));
        }
    }
    const LaneBlock& block = state.blocks[at(lane)];
    for (int slot = block.first; slot < block.stop(); ++slot) insiders.push_back(insider(v, slot, 0.0));
    const LaneBlock& before = state.blocks[at(road.origin)];
    const Lane& origin = model.graph.lanes[at(road.origin)];
    for (int slot = before.first; slot < before.stop(); ++slot) {
        if (v.position_m[at(slot)] <= origin.stop_line_m) break;
        if (v.next_lane[at(slot)] == lane) insiders.push_back(insider(v, slot, -origin.length_m));
    }
}

// Time to cover a distance, accelerating up to the limit.
double earliest_s(double distance_m, double speed_mps, double acceleration_mps2, double limit_mps) {
    const double to_limit_mps = std::max(limit_mps - speed_mps, 0.0);
    const double to_limit_m = to_limit_mps * (speed_mps + 0.5 * to_limit_mps) / acceleration_mps2;
    if (distance_m <= to_limit_m) {
        return (std::sqrt(square(speed_mps) + 2.0 * acceleration_mps2 * distance_m) - speed_mps) / acceleration_mps2;
    }
    return to_limit_mps / acceleration_mps2 + (distance_m - to_limit_m) / std::max(limit_mps, speed_mps);
}

// Stands right behind a vehicle that stands: it will not come, nor will those behind it.
bool blocked(const State& state, int slot) {
    const VehicleArrays& v = state.vehicles;
    const std::size_t i = at(slot);
    const double gap_m = v.position_m[i - 1] - v.length_m[i - 1] - v.position_m[i];
    return v.predecessor[i] >= 0 && v.speed_mps[i] < kStanding_mps && v.speed_mps[i - 1] < kStanding_mps &&
           gap_m < kCloseBehind_m;
}

// The same of one past the stop line on the way to `lane`, whose predecessor waits for others.
bool behind_held(const Model& model, const State& state, int lane, const Insider& w) {
    if (!blocked(state, w.slot)) return false;
    const int on = w.front_m > 0.0 ? lane : model.graph.lanes[at(lane)].origin;
    const bool first = w.slot == state.blocks[at(on)].first;
    const int ahead = first ? vehicle_ahead(model, state, on, w.slot, kSeen_m).slot : w.slot - 1;
    return ahead >= 0 && held(state, ahead);
}

// When the next vehicle of the other lane, inside or before its stop line, can be at the conflict area; those that will stop
// at the light do not count. Looks no further ahead than `horizon_s`.
double next_arrival_s(const Model& model, const State& state, const Conflict& conflict, double horizon_s) {
    const VehicleArrays& v = state.vehicles;
    const Lane& other = model.graph.lanes[at(conflict.other)];
    const Lane& origin = model.graph.lanes[at(other.origin)];
    const double a = model.give_way.approach_mps2;
    const bool green = state.lights[at(origin.signal_group)] == Light::green;
    const int stopping = green ? -1 : state.stop_slot[at(other.origin)];
    double soonest_s = kNever_s;
    for (const Insider& w : state.insiders[at(conflict.other)]) {
        if (w.front_m >= conflict.other_from_m) continue;
        if (held(state, w.slot) || w.slot == stopping || behind_held(model, state, conflict.other, w)) {
            return soonest_s;
        }
        const double distance_m = conflict.other_from_m - w.front_m;
        soonest_s = std::min(soonest_s, earliest_s(distance_m, v.speed_mps[at(w.slot)], a, other.limit_mps));
    }
    const LaneBlock& block = state.blocks[at(other.origin)];
    if (block.count == 0 || blocked(state, block.first) || held(state, block.first)) return soonest_s;
    for (int slot = block.first; slot < block.stop(); ++slot) {
        const double distance_m = origin.length_m + conflict.other_from_m - v.position_m[at(slot)];
        if (distance_m > horizon_s * origin.limit_mps) break;
        if (slot == stopping) break;
        if (v.position_m[at(slot)] > origin.stop_line_m || v.next_lane[at(slot)] != conflict.other) continue;
        return std::min(soonest_s, earliest_s(distance_m, v.speed_mps[at(slot)], a, other.limit_mps));
    }
    return soonest_s;
}

struct Candidate {
    int slot;
    double front_m;  // along the lane inside
    bool inside;
    bool stands;
};

// Whether the other lane's vehicles let this one into the area, without regard to gaps.
bool area_free(const Model& model, const State& state, const Conflict& conflict, const Candidate& v,
               std::int64_t since) {
    const int stopping = state.stop_slot[at(model.graph.lanes[at(conflict.other)].origin)];
    for (const Insider& w : state.insiders[at(conflict.other)]) {
        if (w.rear_m >= conflict.other_to_m) continue;
        if (w.front_m > conflict.other_from_m) return false;
        if (conflict.yields || w.slot == stopping) continue;
        if (conflict.other_yields) {
            if (state.vehicles.cleared_for[at(w.slot)] == conflict.other && !held(state, w.slot)) return false;
            continue;
        }
        // Two that stand and wait for each other: who can go does. The other sees it in the area.
        if (v.stands && (held(state, w.slot) || behind_held(model, state, conflict.other, w))) continue;
        const bool before = w.since < since || (w.since == since && w.slot < v.slot);
        if (!v.inside || before) return false;
    }
    return true;
}

// Whether every vehicle with priority is far enough for this one to go; notes the decision.
bool accepts_gap(const Model& model, State& state, int lane, const Candidate& v, double to_hold_m) {
    VehicleArrays& arrays = state.vehicles;
    const double reach_s = to_hold_m / std::max(arrays.speed_mps[at(v.slot)], 2.0);
    const double needed_s = model.give_way.critical_gap_s + std::max(reach_s, 0.0);
    double gap_s = kNever_s;
    for (const Conflict& conflict : model.graph.conflicts[at(lane)]) {
        if (!conflict.yields || v.front_m > conflict.from_m) continue;
        gap_s = std::min(gap_s, next_arrival_s(model, state, conflict, needed_s));
        if (gap_s < needed_s) return false;
    }
    arrays.cleared_for[at(v.slot)] = lane;
    state.gaps_accepted.push_back({model.time_s(state.tick), arrays.id[at(v.slot)], lane, static_cast<float>(gap_s),
                                   static_cast<float>(needed_s)});
    return true;
}

// Where this vehicle must wait, along the lane inside; beyond the lane where it need not.
constexpr double kNowhere_m = 1e9;

double waiting_place(const Model& model, State& state, int lane, const Candidate& v) {
    VehicleArrays& arrays = state.vehicles;
    const double speed = arrays.speed_mps[at(v.slot)];
    const double margin_m = model.give_way.margin_m;
    // Nearer than this it must know whether it can go on.
    const double ahead_m = 0.5 * square(speed) / model.driver.stop.deceleration_mps2 + 1.5 * speed + 3.0;
    // A gap that it could not use, because somebody stands in front, is lost; others must not wait for it.
    if (v.stands && blocked(state, v.slot)) arrays.cleared_for[at(v.slot)] = -1;
    bool decided = arrays.cleared_for[at(v.slot)] == lane;
    for (const Conflict& conflict : model.graph.conflicts[at(lane)]) {
        const double hold_m = conflict.from_m - margin_m;
        if (v.front_m > conflict.from_m) continue;
        if (hold_m - v.front_m > ahead_m) break;
        if (!area_free(model, state, conflict, v, arrays.inside_since[at(v.slot)])) return hold_m;
        if (conflict.yields && !decided) {
            decided = accepts_gap(model, state, lane, v, hold_m - v.front_m);
            if (!decided) return hold_m;
        }
    }
    return kNowhere_m;
}

// Remembers the first waiting vehicle of a lane.
void wait(State& state, int lane, int slot, double place_m) {
    state.vehicles.held_at[at(slot)] = static_cast<int>(state.tick);
    int& waiting = state.hold_slot[at(lane)];
    if (waiting >= 0 && waiting <= slot) return;
    waiting = slot;
    state.hold_m[at(lane)] = place_m;
}

void decide(const Model& model, State& state, int lane) {
    const Lane& road = model.graph.lanes[at(lane)];
    const Lane& origin = model.graph.lanes[at(road.origin)];
    const VehicleArrays& v = state.vehicles;
    const LaneBlock& block = state.blocks[at(lane)];
    for (int slot = block.first; slot < block.stop(); ++slot) {
        const double hold_m = waiting_place(
            model, state, lane, {slot, v.position_m[at(slot)], true, v.speed_mps[at(slot)] < kStanding_mps});
        if (hold_m < kNowhere_m) return wait(state, lane, slot, hold_m);
    }
    constexpr double kLookBack_m = 60.0;
    const LaneBlock& before = state.blocks[at(road.origin)];
    for (int slot = before.first; slot < before.stop(); ++slot) {
        const double position_m = v.position_m[at(slot)];
        if (origin.length_m - position_m > kLookBack_m || slot == state.stop_slot[at(road.origin)]) break;
        if (v.next_lane[at(slot)] != lane) continue;
        const Candidate candidate{slot, position_m - origin.length_m, position_m > origin.stop_line_m,
                                  v.speed_mps[at(slot)] < kStanding_mps};
        const double hold_m = waiting_place(model, state, lane, candidate);
        if (hold_m < kNowhere_m) return wait(state, road.origin, slot, hold_m + origin.length_m);
    }
}

std::int64_t vehicles_in(const std::vector<Insider>& insiders, double from_m, double to_m) {
    return std::count_if(insiders.begin(), insiders.end(),
                         [&](const Insider& w) { return w.front_m > from_m && w.rear_m < to_m; });
}

}  // namespace

void give_way(const Model& model, State& state) {
    const auto lanes = static_cast<int>(model.graph.conflicts.size());
    for (int lane = 0; lane < lanes; ++lane) {
        state.hold_slot[at(lane)] = -1;
        if (model.graph.lanes[at(lane)].origin < 0) continue;
        std::vector<Insider>& insiders = state.insiders[at(lane)];
        list_insiders(model, state, lane, insiders);
        if (!insiders.empty()) {
            state.longest_inside = std::max(state.longest_inside, state.tick - insiders.front().since);
        }
    }
    for (int lane = 0; lane < lanes; ++lane) {
        const std::vector<Conflict>& conflicts = model.graph.conflicts[at(lane)];
        const auto matters = [&](const Conflict& c) { return c.yields || !state.insiders[at(c.other)].empty(); };
        if (!std::any_of(conflicts.begin(), conflicts.end(), matters)) continue;
        decide(model, state, lane);
        if (state.insiders[at(lane)].empty()) continue;
        for (const Conflict& c : conflicts) {
            if (c.other < lane || state.insiders[at(c.other)].empty()) continue;
            state.violations.conflicts += vehicles_in(state.insiders[at(lane)], c.from_m, c.to_m) *
                                          vehicles_in(state.insiders[at(c.other)], c.other_from_m, c.other_to_m);
        }
    }
}

}  // namespace stopline
