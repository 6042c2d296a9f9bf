// Giving way inside intersections: who is there, who must wait before which conflict area. The state at the beginning of the
// step decides. Behind the first vehicle of a lane that waits no gap is looked for; those behind it still keep out of areas where others
// are or come first.
//
// A vehicle may go into a conflict area
//   - when no vehicle of the other lane is in it, nor on its way to it after it has accepted a gap;
//   - where it has to give way: when the next vehicle with priority is further away than the critical gap and the time it
//     takes to get to the area; this is decided for all areas where it has to give way, and again as long as it could
//     still stop comfortably: who waited when it was decided may have set out, and others with it;
//   - where neither has priority (movements of different signal groups): when no vehicle that passed its stop line
//     before is still to come; of two that stand and wait for each other, when they have agreed so.
// A vehicle that has stood inside for long may be passed where the rules say so (driver/hindrance_rules.h).
#include <algorithm>
#include <cmath>

#include "base/arithmetic.h"
#include "sim/arrivals.h"
#include "sim/phases.h"

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

// Time to a waiting place, slowing down to the limit of the way beyond it.
double reach_s(const Model& model, double distance_m, double speed_mps, double limit_mps) {
    constexpr double kSlowest_mps = 2.0;
    const double b = model.driver.deceleration_mps2;
    const double slowing_m = 0.5 * (square(speed_mps) - square(limit_mps)) / b;
    if (slowing_m <= 0.0) return std::max(distance_m, 0.0) / std::max(speed_mps, kSlowest_mps);
    if (distance_m >= slowing_m) return (distance_m - slowing_m) / speed_mps + (speed_mps - limit_mps) / b;
    return (speed_mps - std::sqrt(square(speed_mps) - 2.0 * b * std::max(distance_m, 0.0))) / b;
}

// To a comfortable stop.
double stopping_m(const Model& model, double speed_mps) {
    return 0.5 * square(speed_mps) / model.driver.stop.deceleration_mps2;
}

// The same with what the brake's lag takes in full dynamics: who is nearer than this cannot be relied on to stop.
double sure_stopping_m(const Model& model, double speed_mps) {
    return model.meso ? stopping_m(model, speed_mps) : stopping_distance_m(model.driver, speed_mps);
}

struct Candidate {
    int slot;
    double front_m;  // along the lane inside
    bool inside;
    bool stands;
};

// Whether `vehicle` may pass one that has stood inside for long, although it is in its way. Where ways merge it cannot. Once it may, it
// may until it is through: it could be too late to stop when the other sets out at last.
bool may_pass(const Model& model, State& state, NetworkPart& part, int vehicle, int lane, int blocker, int other) {
    const VehicleArrays& v = state.vehicles;
    if (model.rules.pass_blocker_ticks == 0) return false;
    for (Passing& known : part.passing) {
        if (known.vehicle != v.id[at(vehicle)] || known.blocker != v.id[at(blocker)]) continue;
        known.seen = state.tick;
        return true;
    }
    const std::int64_t stood = state.tick - v.stands_since[at(blocker)];
    if (stood < model.rules.pass_blocker_ticks) return false;
    if (state.plan.lane(lane).exit == state.plan.lane(other).exit) return false;
    part.passing.push_back({v.id[at(vehicle)], v.id[at(blocker)], state.tick, stood, false});
    return true;
}

// The agreement between two without priority that the first goes, if there is one.
Agreed* agreement(const State& state, NetworkPart& part, int goes, int waits) {
    const VehicleArrays& v = state.vehicles;
    const auto found = std::find_if(part.agreed.begin(), part.agreed.end(), [&](const Agreed& a) {
        return a.goes == v.id[at(goes)] && a.waits == v.id[at(waits)];
    });
    return found == part.agreed.end() ? nullptr : &*found;
}

// The slot of a vehicle of the other lane that keeps this one out of the area, without regard to gaps; -1: none.
int keeps_out(const Model& model, State& state, NetworkPart& part, int lane, const Conflict& conflict,
              const Candidate& v) {
    const std::int64_t since = state.vehicles.record[at(v.slot)].inside_since;
    const int stopping = state.stop_slot[at(state.plan.lane(conflict.other).origin)];
    for (const Insider& w : state.insiders[at(conflict.other)]) {
        if (w.rear_m >= conflict.other_to_m) continue;
        if (may_pass(model, state, part, v.slot, lane, w.slot, conflict.other)) continue;
        if (w.front_m > conflict.other_from_m) return w.slot;
        if (conflict.yields || w.slot == stopping) continue;
        if (conflict.other_yields) {
            const bool comes = state.vehicles.record[at(w.slot)].cleared_for == conflict.other &&
                               !held_before(state, w.slot, conflict.other_from_m);
            if (comes) return w.slot;
            continue;
        }
        // Two that stand and wait for each other: who can go does, and the other waits for it as long as nothing else holds it up.
        if (agreement(state, part, w.slot, v.slot) != nullptr) return w.slot;
        if (Agreed* const agreed = agreement(state, part, v.slot, w.slot)) {
            agreed->seen = state.tick;
            continue;
        }
        if (v.stands && (held(state, w.slot) || behind_held(state, conflict.other, w))) {
            part.agreed.push_back({state.vehicles.id[at(v.slot)], state.vehicles.id[at(w.slot)], state.tick});
            continue;
        }
        const bool before = w.since < since || (w.since == since && w.slot < v.slot);
        if (!v.inside || before) return w.slot;
    }
    return -1;
}

// What a slow way through a long area takes beyond the critical gap: turning round, say. Generated networks have none of these.
double more_for_s(const Model& model, int lane, const Conflict& conflict, double limit_mps, double length_m) {
    constexpr double kSpare_s = 1.5;
    if (model.demand.trips.empty() || model.graph.lanes[at(lane)].origin < 0) return 0.0;
    const double through_s = (conflict.to_m - conflict.from_m + length_m) / limit_mps + kSpare_s;
    return std::max(through_s - model.give_way.critical_gap_s, 0.0);
}

// Of several that stood and gave way to each other in a circle, one that goes although this one comes before it; -1: none.
int sets_out_first(const Model& model, const State& state, int lane, const Candidate& v) {
    if (model.demand.trips.empty() || !v.stands) return -1;
    for (const Conflict& conflict : state.plan.conflicts(lane)) {
        if (!conflict.other_yields) continue;
        const LaneBlock& block = state.blocks[at(state.plan.lane(conflict.other).origin)];
        if (block.count == 0 || held(state, block.first)) continue;
        const VehicleArrays& arrays = state.vehicles;
        if (arrays.next_lane[at(block.first)] != conflict.other) continue;
        if (arrays.record[at(block.first)].cleared_for == conflict.other) return block.first;
    }
    return -1;
}

// The slot of a vehicle of the other lane that gives way to this one but set out when this one stood and waited, and cannot stop before its
// first area any more, where it would decide again; -1: none.
int cannot_stop(const Model& model, const State& state, const Conflict& conflict) {
    const VehicleArrays& v = state.vehicles;
    const LanePlan& origin = state.plan.lane(state.plan.lane(conflict.other).origin);
    const LaneBlock& block = state.blocks[at(state.plan.lane(conflict.other).origin)];
    for (int slot = block.first; slot < block.stop(); ++slot) {
        if (v.next_lane[at(slot)] != conflict.other) continue;
        const double speed_mps = v.speed_mps[at(slot)];
        const double first_m = state.plan.lane(conflict.other).first_area_m - model.give_way.margin_m;
        const double to_area_m = origin.length_m + first_m - v.position_m[at(slot)];
        const bool comes = v.record[at(slot)].cleared_for == conflict.other && speed_mps >= kAlmostStands_mps;
        return comes && to_area_m < stopping_m(model, speed_mps) ? slot : -1;
    }
    return -1;
}

// The slot of a vehicle with priority that is too near for this one to go; -1: none. The decision is noted.
int comes_first(const Model& model, State& state, NetworkPart& part, int lane, const Candidate& v, double to_hold_m) {
    VehicleArrays& arrays = state.vehicles;
    VehicleRecord& record = arrays.record[at(v.slot)];
    const double limit_mps = state.plan.lane(lane).limit_mps;
    const double needed_s =
        model.give_way.critical_gap_s + reach_s(model, to_hold_m, arrays.speed_mps[at(v.slot)], limit_mps);
    const bool again = record.cleared_for == lane;
    record.cleared_for = -1;
    if (const int goes = sets_out_first(model, state, lane, v); goes >= 0) return goes;
    Arrival next;
    for (const Conflict& conflict : state.plan.conflicts(lane)) {
        if (!conflict.yields || v.front_m > conflict.from_m) continue;
        const double until_s = needed_s + more_for_s(model, lane, conflict, limit_mps, arrays.length_m[at(v.slot)]);
        const Arrival arrival = next_arrival(model, state, conflict, until_s);
        next.earlier(arrival.in_s, arrival.slot);
        if (arrival.in_s < until_s) return arrival.slot;
    }
    record.cleared_for = lane;
    // Where each of several gives way to the next one, in a circle, the first that goes is no longer held up.
    if (!model.demand.trips.empty()) record.held_at = -2;
    if (!model.records_all || again) return -1;
    part.gaps_accepted.push_back({model.time_s(state.tick), arrays.id[at(v.slot)], lane, static_cast<float>(next.in_s),
                                  static_cast<float>(needed_s)});
    return -1;
}

// Whether one that cannot stop any more is still in the area when this one, with priority and on the move, can be there at the earliest:
// it came later, or got on worse, than was foreseen when it accepted its gap.
bool still_there(const Model& model, const State& state, int lane, const Conflict& conflict, const Candidate& v,
                 int other) {
    const VehicleArrays& arrays = state.vehicles;
    const LanePlan& way = state.plan.lane(conflict.other);
    const double in_s = earliest_s(std::max(conflict.from_m - v.front_m, 0.0), arrays.speed_mps[at(v.slot)],
                                   model.give_way.approach_mps2, state.plan.lane(lane).limit_mps);
    const double speed_mps = arrays.speed_mps[at(other)];
    const double to_way_m = state.plan.lane(way.origin).length_m - arrays.position_m[at(other)];
    const double through_m = conflict.other_to_m + arrays.length_m[at(other)];
    return reach_s(model, to_way_m, speed_mps, way.limit_mps) + through_m / std::min(speed_mps, way.limit_mps) > in_s;
}

// Where this vehicle must wait, along the lane inside, and for what; beyond the lane where it need not.
constexpr double kNowhere_m = 1e9;
struct Wait {
    double place_m = kNowhere_m;
    int blocker = -1;
    bool priority = false;
};

// Of a way on which one does not wait inside, for one that can still stop before the line: where, along the lane inside; else nowhere.
double waits_at_line_m(const Model& model, const State& state, int lane, const Candidate& v) {
    if (v.inside || state.plan.waits_inside(lane)) return kNowhere_m;
    const LanePlan& origin = state.plan.lane(state.plan.lane(lane).origin);
    const double line_m = origin.stop_line_m - origin.length_m - model.driver.stop.margin_m;
    const double speed_mps = state.vehicles.speed_mps[at(v.slot)];
    return v.stands || line_m - v.front_m >= stopping_m(model, speed_mps) ? line_m : kNowhere_m;
}

// `ahead`: slot of one that waits ahead on the same way, -1: none. Behind it no gap is looked for.
Wait waiting_place(const Model& model, State& state, NetworkPart& part, int lane, const Candidate& v, int ahead) {
    VehicleArrays& arrays = state.vehicles;
    const double speed = arrays.speed_mps[at(v.slot)];
    const double margin_m = model.give_way.margin_m;
    const double ahead_m = decides_within_m(model, speed);
    // A gap that it could not use, because somebody stands in front, is lost; others must not wait for it.
    if (v.stands && blocked(state, v.slot)) arrays.record[at(v.slot)].cleared_for = -1;
    bool decided = arrays.record[at(v.slot)].cleared_for == lane;
    const double to_first_m = state.plan.lane(lane).first_area_m - margin_m - v.front_m;
    if (!v.stands && to_first_m > stopping_m(model, speed)) decided = false;
    const bool others = state.with_insiders.has_any(state.plan.meets(lane));
    const double line_m = waits_at_line_m(model, state, lane, v);
    const bool at_line = line_m < kNowhere_m;
    const bool no_light = state.plan.light_before(state.plan.lane(lane).origin, lane) == 0;
    if (at_line && line_m - v.front_m > ahead_m) return {};
    const bool waits = v.stands || arrays.record[at(v.slot)].held_at >= state.tick - 1;
    const double braking_m = 0.5 * square(speed) / model.driver.cacc.deceleration_emergency_mps2;
    const bool minds_late = waits || !model.demand.trips.empty();
    if (!others && !minds_late && (decided || !state.plan.lane(lane).yields)) return {};
    for (const Conflict& conflict : state.plan.conflicts(lane)) {
        const double hold_m = conflict.from_m - margin_m;
        if (v.front_m > conflict.from_m) continue;
        const bool far = hold_m - v.front_m > ahead_m;
        if (far && !at_line) break;
        const bool empty = !others || state.insiders[at(conflict.other)].empty();
        int blocker = empty ? -1 : keeps_out(model, state, part, lane, conflict, v);
        if (blocker < 0 && minds_late && conflict.other_yields && conflict.from_m - v.front_m >= braking_m) {
            const int comes = cannot_stop(model, state, conflict);
            if (comes >= 0 && (waits || still_there(model, state, lane, conflict, v, comes))) blocker = comes;
        }
        const bool matters = !far || no_light || (blocker >= 0 && arrays.speed_mps[at(blocker)] < kAlmostStands_mps);
        if (blocker >= 0 && matters) return {std::min(hold_m, line_m), blocker, false};
        if (conflict.yields && !decided) {
            const int first = ahead >= 0 ? ahead : comes_first(model, state, part, lane, v, hold_m - v.front_m);
            if (first >= 0) return {std::min(hold_m, line_m), first, true};
            decided = true;
        }
    }
    return {};
}

// Remembers who waits; of those on one lane the first ones.
void wait(State& state, NetworkPart& part, int lane, int slot, double place_m, const Wait& wait) {
    VehicleRecord& record = state.vehicles.record[at(slot)];
    record.held_at = static_cast<int>(state.tick);
    record.held_m =
        static_cast<float>(place_m - (state.plan.lane(lane).origin < 0 ? state.plan.lane(lane).length_m : 0.0));
    hold(state, part, lane, {slot, place_m, wait.blocker, wait.priority});
}

void decide(const Model& model, State& state, NetworkPart& part, int lane) {
    const LanePlan& plan = state.plan.lane(lane);
    const LanePlan& origin = state.plan.lane(plan.origin);
    const VehicleArrays& v = state.vehicles;
    const LaneBlock& block = state.blocks[at(lane)];
    int ahead = -1;
    const auto place_of = [&](const Candidate& candidate) {
        const Wait found = waiting_place(model, state, part, lane, candidate, ahead);
        if (found.place_m < kNowhere_m) {
            ahead = candidate.slot;
            // A gap accepted before is lost to one that stops before using it: when it sets out again, others have come.
            double room_m = found.place_m - candidate.front_m;
            for (const Conflict& c : state.plan.conflicts(lane)) {
                const double to_area_m = c.from_m - model.give_way.margin_m - candidate.front_m;
                if (c.yields && c.from_m >= candidate.front_m) room_m = std::min(room_m, to_area_m);
            }
            const bool stops = sure_stopping_m(model, v.speed_mps[at(candidate.slot)]) <= room_m;
            if (candidate.stands || stops) state.vehicles.record[at(candidate.slot)].cleared_for = -1;
        }
        return found;
    };
    for (int slot = block.first; slot < block.stop(); ++slot) {
        const Wait found = place_of({slot, v.position_m[at(slot)], true, v.speed_mps[at(slot)] < kAlmostStands_mps});
        if (found.place_m < kNowhere_m) wait(state, part, lane, slot, found.place_m, found);
    }
    std::vector<int>& coming = state.coming[at(lane)];
    for (const int slot : coming) {
        const double position_m = v.position_m[at(slot)];
        const Candidate candidate{slot, position_m - origin.length_m, position_m > origin.stop_line_m,
                                  v.speed_mps[at(slot)] < kAlmostStands_mps};
        const Wait found = place_of(candidate);
        if (found.place_m < kNowhere_m) wait(state, part, plan.origin, slot, found.place_m + origin.length_m, found);
    }
    coming.clear();
}

}  // namespace

void give_way(const Model& model, State& state, NetworkPart& part) {
    // Between two areas of the same pair there may be some steps.
    constexpr std::int64_t kAgreed_steps = 5;
    std::erase_if(part.agreed, [&](const Agreed& a) { return state.tick - a.seen > kAgreed_steps; });
    std::erase_if(part.passing, [&](const Passing& p) { return state.tick - p.seen > model.rules.memory_ticks; });
    for (const int lane : part.holding) {
        state.holds[at(lane)].count = 0;
        state.has_holds[at(lane)] = 0;
    }
    part.holding.clear();
    state.deciding.keep_if(part.first_word, part.end_word, [&](std::size_t mark) {
        decide(model, state, part, state.plan.marked(mark));
        return false;
    });
    count_conflicts(model, state, part);
}

}  // namespace stopline
