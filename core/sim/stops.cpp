// Who stops at the stop line: for its light, or to keep the intersection clear.
#include <algorithm>
#include <array>
#include <cmath>

#include "base/arithmetic.h"
#include "sim/arrivals.h"
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

double stops_with_mps2(const Model& model, Light light) {
    return light == Light::yellow ? model.driver.stop.decision_deceleration_mps2
                                  : model.driver.cacc.deceleration_emergency_mps2;
}

// Told where it takes nearly all that its brakes give. can_stop() leaves out that changing down takes from that, by up to a tenth in all; in the
// mesoscale mode nobody changes down.
bool can_barely_stop(const Model& model, const VehicleArrays& v, int slot, double line_m, Light light) {
    constexpr double kSure = 0.9;
    const double sure_mps2 = kSure * model.driver.cacc.deceleration_emergency_mps2;
    if (model.meso || stops_with_mps2(model, light) <= sure_mps2) return false;
    return !can_stop(model, v, slot, line_m, sure_mps2);
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
    const double deceleration_mps2 = stops_with_mps2(model, light);
    for (int slot = block.first; slot < block.stop(); ++slot) {
        if (trip_ends(state, slot)) continue;
        if (can_stop(model, state.vehicles, slot, line_m, deceleration_mps2)) return slot;
    }
    return -1;
}

bool line_is_open(const Model& model, const State& state, int signal_group, const StopLineState& line) {
    if (state.lights[at(signal_group)] != Light::green) return false;
    // The vehicle that waits at the line hesitates at the start of green.
    return line.stopper < 0 || state.tick >= model.signals[at(signal_group)].since(state.tick) + model.hesitation_ticks;
}

double needs_m(const VehicleArrays& v, int slot) {
    return static_cast<double>(v.length_m[at(slot)]) + static_cast<double>(v.standstill_gap_m[at(slot)]);
}

// Where movements have lights of their own: the first vehicle whose light is not green and that can stop does.
int choose_stopper_by_way(const Model& model, const State& state, int index, const StopLineState& line) {
    const LaneBlock& block = state.blocks[at(index)];
    const VehicleArrays& v = state.vehicles;
    for (int slot = block.first; slot < block.stop(); ++slot) {
        if (trip_ends(state, slot)) continue;
        const int group = state.plan.light_before(index, v.next_lane[at(slot)]);
        const Light light = state.lights[at(group)];
        const bool stopped = line.stopper == v.id[at(slot)];
        const bool hesitates =
            stopped && state.tick < model.signals[at(group)].since(state.tick) + model.hesitation_ticks;
        if (light == Light::green && !hesitates) continue;
        const double line_m = state.plan.lane(index).stop_line_m;
        if (stopped || can_stop(model, v, slot, line_m, stops_with_mps2(model, light))) return slot;
    }
    return -1;
}

// The light at a lane's end is not green for its last vehicle: all of them are going to stop, though they move now.
bool minds_light(const Model& model, const State& state, int lane) {
    const LanePlan& plan = state.plan.lane(lane);
    if (!model.rules.minds_light_ahead || plan.signal_group < 0) return false;
    const int next = plan.by_way ? state.vehicles.next_lane[at(state.blocks[at(lane)].last())] : -1;
    return state.lights[at(state.plan.light_before(lane, next))] != Light::green;
}

// Whether somebody on the lane stands or crawls.
bool is_slow(const State& state, const LaneBlock& block) {
    const std::span<const double> all(state.vehicles.speed_mps.data(), at(state.vehicles.slots));
    bool slow = false;
    for (const double mps : all.subspan(at(block.first), at(block.count))) slow |= mps < kAlmostStands_mps;
    return slow;
}

// Looked for once a step, by whoever asks first.
const ExitRoom& look_into_exit(const Model& model, State& state, int exit) {
    const VehicleArrays& v = state.vehicles;
    ExitRoom& room = state.exit_rooms[at(exit)];
    if (room.tick == state.tick) return room;
    room = {state.tick, 1e9, -1};
    const LaneBlock& block = state.blocks[at(exit)];
    if (block.count == 0) return room;
    const double line_m = state.plan.lane(exit).turn_m;  // its stop line or end
    const bool have_to_wait = line_m <= model.rules.sight_m && minds_light(model, state, exit);
    if (!have_to_wait && !is_slow(state, block)) return room;
    double moving_m = 0.0;
    double leaving_m = 0.0;  // of that, those that have passed its stop line
    for (int slot = block.last(); slot >= block.first; --slot) {
        const double rear_m = v.position_m[at(slot)] - static_cast<double>(v.length_m[at(slot)]);
        if (rear_m > model.rules.sight_m) return room;
        if (v.speed_mps[at(slot)] < kAlmostStands_mps) {
            room.standing = slot;
            room.room_m = rear_m - moving_m;
            break;
        }
        moving_m += needs_m(v, slot);
        if (v.position_m[at(slot)] > line_m) leaving_m += needs_m(v, slot);
    }
    if (room.standing < 0 && have_to_wait) {
        room.standing = block.last();
        room.room_m = line_m - model.driver.stop.margin_m - (moving_m - leaving_m);
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
    if (!state.with_standing.has_any(state.plan.meets(inside))) return -1;
    const VehicleArrays& v = state.vehicles;
    const std::int64_t patience = model.rules.pass_blocker_ticks;
    for (const Conflict& c : state.plan.conflicts(inside)) {
        if (c.yields || c.other_yields) continue;
        for (const Insider& w : state.insiders[at(c.other)]) {
            if (w.front_m <= c.other_from_m || w.rear_m >= c.other_to_m || v.speed_mps[at(w.slot)] >= kAlmostStands_mps)
                continue;
            if (patience > 0 && state.tick - v.stands_since[at(w.slot)] >= patience) continue;
            return w.slot;
        }
    }
    return -1;
}

// One way on from a stop line.
struct Way {
    int inside;
    int standing;  // see ExitRoom
    int across;    // slot of who stands across it
    double room_m;
    bool clear;  // for all who come
};

// The ways on from a lane, as far as somebody who comes to the stop line takes them.
class Ways {
public:
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): each_ is written before it is read, and there is one each step and lane
    Ways(const Model& model, State& state, int vehicles)
        : model_(model), state_(state), ample_m_(vehicles * state.plan.needs_at_most_m() + kRounding_m) {}

    // nullptr: it is entered whatever is in its exit.
    Way* to(int inside) {
        if (last_ != nullptr && last_->inside == inside) return last_;
        return last_ = find(inside);
    }

private:
    Way* find(int inside) {
        for (std::size_t k = 0; k < count_; ++k) {
            if (each_[k].inside == inside) return &each_[k];
        }
        if (inside < 0 || count_ == each_.size()) return nullptr;
        const LanePlan& plan = state_.plan.lane(inside);
        if (plan.exit < 0 || !plan.keeps_clear) return nullptr;
        const ExitRoom& room = look_into_exit(model_, state_, plan.exit);
        const int across = stands_across(model_, state_, inside);
        each_[count_] = {inside, room.standing, across, room.room_m, across < 0 && room.room_m >= ample_m_};
        return &each_[count_++];
    }

    static constexpr double kRounding_m = 1e-3;

    const Model& model_;
    State& state_;
    double ample_m_;  // room for all vehicles of the lane
    std::array<Way, 16> each_;
    std::size_t count_ = 0;
    Way* last_ = nullptr;  // most go the same way as who is ahead of them
};

// Whether a vehicle that is kept out of an intersection can stop comfortably. Who has not begun to brake for the line, since drivers begin late
// (`stop.deceleration`), must be taken to be able to; in the mesoscale mode, where no brake lags, nearly up to the line.
bool can_be_kept_out(const Model& model, const VehicleArrays& v, int slot, double line_m) {
    constexpr double kHarder = 1.4;  // than braking begins with: what the brake's lag takes
    const CaccSettings& cacc = model.driver.cacc;
    const double later_mps2 = std::min(kHarder * model.driver.stop.deceleration_mps2, cacc.deceleration_emergency_mps2);
    if (later_mps2 <= cacc.deceleration_comfort_mps2) {
        return can_stop(model, v, slot, line_m, cacc.deceleration_comfort_mps2);
    }
    if (!model.meso) return can_stop(model, v, slot, line_m, later_mps2);
    return square(v.speed_mps[at(slot)]) <= 2.0 * later_mps2 * (line_m - v.position_m[at(slot)]);
}

// The first vehicle that finds no room in its exit, or somebody across its way, and can stop comfortably; -1: none.
int keep_clear(const Model& model, State& state, int index) {
    constexpr double kDecides_m = 80.0;  // before the stop line, at most
    const VehicleArrays& v = state.vehicles;
    const double line_m = state.plan.lane(index).stop_line_m;
    const LaneBlock& block = state.blocks[at(index)];
    Ways ways(model, state, block.count);
    for (int slot = block.first; slot < block.stop(); ++slot) {
        if (v.position_m[at(slot)] < line_m - kDecides_m) break;
        Way* const way = ways.to(v.next_lane[at(slot)]);
        if (way == nullptr || way->clear) continue;
        way->room_m -= needs_m(v, slot);
        if ((way->room_m >= 0.0 && way->across < 0) || v.position_m[at(slot)] > line_m) continue;
        if (!can_be_kept_out(model, v, slot, line_m)) continue;
        state.kept_out[at(index)] = way->across >= 0 ? KeptOut{way->across, false} : KeptOut{way->standing, true};
        return slot;
    }
    return -1;
}

// Each vehicle that is kept out is told of once, when that begins.
void note_kept_out(const Model& model, const State& state, NetworkPart& part, int index, int slot,
                   StopLineState& line) {
    const VehicleArrays& v = state.vehicles;
    const int id = slot < 0 ? -1 : v.id[at(slot)];
    if (id >= 0 && id != line.kept_out && model.rules.watches()) {
        const int blocker = state.kept_out[at(index)].blocker;
        const std::int64_t stood = blocker < 0 ? 0 : state.tick - v.stands_since[at(blocker)];
        part.rules.push_back({RuleUse::Kind::kept_out, model.time_s(state.tick), id, index,
                              blocker < 0 ? -1 : v.id[at(blocker)], model.time_s(stood)});
    }
    line.kept_out = id;
}

// Who stops at the line for its light from now on.
void tell_to_stop(const Model& model, const State& state, int index, int slot, StopLineState& line) {
    const VehicleArrays& v = state.vehicles;
    const int id = slot < 0 ? -1 : v.id[at(slot)];
    if (id >= 0 && id != line.stopper) {
        const Light light = state.lights[at(state.plan.light_before(index, v.next_lane[at(slot)]))];
        line.barely = can_barely_stop(model, v, slot, state.plan.lane(index).stop_line_m, light);
    }
    line.stopper = id;
}

// It leads what follows it through the next green. One that came to stand a little beyond the line sets out when that lets it. Of one
// before the line nothing else is changed: its rear may still be in the intersection behind, which another thread looks at.
void note_stop(State& state, const LanePlan& lane, int slot) {
    state.vehicles.leads[at(slot)] = 1.0F;
    if (state.vehicles.position_m[at(slot)] > lane.stop_line_m) {
        state.vehicles.record[at(slot)].inside_since = static_cast<int>(state.tick);
    }
}

// Those that will not stop here and are near to where ways meet, in front of them.
void list_coming(const Model& model, State& state, int index) {
    constexpr double kLookBack_m = 60.0;   // of 50 km/h and a comfortable stop
    constexpr double kFastBack_m = 160.0;  // imported networks have faster roads
    const bool has_trips = !model.demand.trips.empty();
    const double look_back_m = has_trips ? kFastBack_m : kLookBack_m;
    const VehicleArrays& v = state.vehicles;
    const double length_m = state.plan.lane(index).length_m;
    const LaneBlock& block = state.blocks[at(index)];
    for (int slot = block.first; slot < block.stop(); ++slot) {
        const double to_end_m = length_m - v.position_m[at(slot)];
        if (to_end_m > look_back_m || slot == state.stop_slot[at(index)]) break;
        const int next = v.next_lane[at(slot)];
        if (next < 0) continue;
        const LanePlan& way = state.plan.lane(next);
        if (way.origin != index || way.mark < 0) continue;
        // With priority, and nobody there: only imported networks have vehicles that come too fast to give way any more.
        if (!has_trips && !way.yields && !state.with_insiders.has_any(state.plan.meets(next))) continue;
        double to_area_m = to_end_m + way.first_area_m - model.give_way.margin_m;
        if (!state.plan.waits_inside(next)) {
            const double line_m = state.plan.lane(index).stop_line_m - model.driver.stop.margin_m;
            to_area_m = std::min(to_area_m, line_m - v.position_m[at(slot)]);
        }
        const bool far = to_area_m > decides_within_m(model, v.speed_mps[at(slot)]);
        if (far && !(way.yields && v.record[at(slot)].cleared_for == next)) continue;
        state.coming[at(next)].push_back(slot);
        if (!state.deciding.has(at(way.mark))) state.plan.fetch_conflicts(next);
        state.deciding.set(at(way.mark));
    }
}

}  // namespace

void read_signals(const Model& model, State& state) {
    for (std::size_t group = 0; group < model.signals.size(); ++group) {
        state.lights[group] = model.signals[group].light(state.tick);
    }
}

void decide_stops(const Model& model, State& state, NetworkPart& part) {
    for (const int index : part.awake_before) {
        fetch_on(state, part.fetching);
        const LanePlan& lane = state.plan.lane(index);
        state.kept_out[at(index)] = {};
        StopLineState& line = state.stop_lines[at(index)];
        const LaneBlock& block = state.blocks[at(index)];
        int stop_slot = -1;
        int kept_slot = -1;
        if (lane.by_way) {
            stop_slot = choose_stopper_by_way(model, state, index, line);
            tell_to_stop(model, state, index, stop_slot, line);
            if (stop_slot >= 0) {
                note_stop(state, lane, stop_slot);
            } else if (model.rules.keep_clear) {
                stop_slot = kept_slot = keep_clear(model, state, index);
            }
        } else if (line_is_open(model, state, lane.signal_group, line)) {
            line.stopper = -1;
            if (model.rules.keep_clear) stop_slot = kept_slot = keep_clear(model, state, index);
        } else {
            if (line.stopper >= 0) stop_slot = slot_of(state.vehicles, block, line.stopper);
            if (stop_slot < 0) {
                stop_slot = choose_stopper(model, state, block, lane.stop_line_m, state.lights[at(lane.signal_group)]);
            }
            tell_to_stop(model, state, index, stop_slot, line);
            if (stop_slot >= 0) note_stop(state, lane, stop_slot);
        }
        if (kept_slot >= 0 || line.kept_out >= 0) note_kept_out(model, state, part, index, kept_slot, line);
        state.stop_slot[at(index)] = stop_slot;
        list_coming(model, state, index);
    }
}

}  // namespace stopline
