// What the first vehicle of a lane sees beyond it, and what a lane asks of its vehicles.
#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/meso_dynamics.h"
#include "sim/phases.h"

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

constexpr double kFar_m = 1e9;

// Where movements part: the vehicle on any of them whose rear is still on the shared stretch, if any.
Ahead still_shared(const Model& model, const State& state, int lane, double& rear_m) {
    const VehicleArrays& v = state.vehicles;
    const double end_m = state.plan.lane(lane).length_m;
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
    const VehicleRecord& record = v.record[at(slot)];
    const LanePlan& here = state.plan.lane(lane);
    double start_m = here.length_m;
    if (record.next_lane < 0 || (!here.branches && start_m - v.position_m[at(slot)] > range_m)) return {};
    Ahead beside;
    double beside_rear_m = kFar_m;
    if (here.branches) beside = still_shared(model, state, lane, beside_rear_m);
    const std::span<const int> route = state.plan.route(record.route);
    for (std::size_t k = at(record.route_index) + 1; k < route.size(); ++k) {
        if (start_m - v.position_m[at(slot)] > range_m) break;
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

// Fetches what will be read and written at a lane's head, and at its end by the lane before.
void fetch_ends(const State& state, int lane) {
    const VehicleArrays& v = state.vehicles;
    const LaneBlock& block = state.blocks[at(lane)];
    for (const int slot : {block.first - 1, block.last()}) {
        __builtin_prefetch(&v.position_m[at(slot)]);
        __builtin_prefetch(&v.speed_mps[at(slot)]);
        __builtin_prefetch(&v.length_m[at(slot)]);
        if (!v.has_powertrain()) continue;
        for (const std::size_t row : {state.v2v.late, state.v2v.later}) {
            __builtin_prefetch(&v.v2v_acceleration_mps2[row + at(slot)]);
            __builtin_prefetch(&v.v2v_request_mps2[row + at(slot)]);
            __builtin_prefetch(&v.v2v_rate_1ps[row + at(slot)]);
        }
    }
    __builtin_prefetch(&v.record[at(block.first)]);
    __builtin_prefetch(&v.id[at(block.last())]);
}

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

void look_beyond_lanes(const Model& model, State& state, NetworkPart& part) {
    constexpr double kNothing_m = 1e6;
    constexpr std::size_t kLanesAhead = 4;
    const bool prefetch = state.outgrows_cache();
    VehicleArrays& v = state.vehicles;
    for (std::size_t k = 0; k < part.awake.size(); ++k) {
        const int lane = part.awake[k];
        if (prefetch && k + kLanesAhead < part.awake.size()) {
            fetch_ends(state, part.awake[k + kLanesAhead]);
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

namespace {

// Brings up to date who rests on a lane: those at its head that set out, and those that came to stand behind.
void find_resting(const VehicleArrays& v, const LaneBlock& block, std::int64_t tick, Resting& resting) {
    const auto rests = [&](int place) {
        const std::size_t i = at(block.first + place);
        return v.speed_mps[i] == 0.0 && v.acceleration_mps2[i] == 0.0F;
    };
    while (resting.from < resting.to && !rests(resting.from)) ++resting.from;
    if (resting.from == resting.to) resting.from = resting.to = 0;
    if (resting.imposed >= tick - 1) {
        resting.to = resting.from;
        return;
    }
    while (resting.to < block.count && rests(resting.to)) ++resting.to;
}

class LaneAdder {
public:
    LaneAdder(const Model& model, State& state, int lane, LaneGroup& group)
        : model_(model),
          state_(state),
          v_(state.vehicles),
          lane_(lane),
          block_(state.blocks[at(lane)]),
          plan_(state.plan.lane(lane)),
          limit_mps_(model.meso ? plan_.limit_mps * model.speed_factor : plan_.limit_mps),
          group_(group) {}

    void add() {
        ++group_.lanes_of_network;
        if (state_.sleeps_until_green_of[at(lane_)] >= 0) return group_.protect(block_.first - 1);
        if (!model_.meso || model_.scalar_kernels) return add(block_.first, block_.stop());
        Resting& resting = state_.resting[at(lane_)];
        if (last_imposed() > block_.first + resting.from) resting.imposed = state_.tick;
        find_resting(v_, block_, state_.tick, resting);
        if (resting.from == 0 && resting.to == block_.count && rests_before_line()) {
            state_.sleeps_until_green_of[at(lane_)] = plan_.signal_group;
            return group_.protect(block_.first - 1);
        }
        if (resting.to - resting.from <= 1) return add(block_.first, block_.stop());
        const int rest_from = block_.first + resting.from + 1;
        const int rest_to = block_.first + resting.to;
        add(block_.first, rest_from);
        group_.protect(rest_from);
        if (rest_to < block_.stop()) add(rest_to, block_.stop());
    }

private:
    // The first vehicle is kept where it is by its light alone.
    bool rests_before_line() const {
        const int first = block_.first;
        if (plan_.signal_group < 0 || state_.stop_slot[at(lane_)] != first) return false;
        if (state_.stop_lines[at(lane_)].stopper != v_.id[at(first)] || state_.holds[at(lane_)].count > 0) return false;
        const double position_m = v_.position_m[at(first)];
        const double room_m = plan_.stop_line_m - model_.driver.stop.margin_m - position_m;
        return position_m <= plan_.stop_line_m && at_rest(stopping_speed_mps(model_, v_, first, room_m)) == 0.0;
    }

    // The last slot that has to stop for something.
    int last_imposed() const {
        const Holds& holds = state_.holds[at(lane_)];
        const int held = holds.count == 0 ? -1 : holds.each[at(holds.count - 1)].slot;
        return plan_.signal_group < 0 ? held : std::max(held, state_.stop_slot[at(lane_)]);
    }

    void add(int from, int to) {
        if (plan_.signal_group >= 0)
            stop_at(state_.stop_slot[at(lane_)], plan_.stop_line_m - model_.driver.stop.margin_m, from, to);
        const Holds& holds = state_.holds[at(lane_)];
        for (int k = 0; k < holds.count; ++k) stop_at(holds.each[at(k)].slot, holds.each[at(k)].place_m, from, to);
        if (model_.meso && from == block_.first && v_.record[at(from)].predecessor < 0) {
            impose(from, from, leading_speed_mps(model_, v_.speed_mps[at(from)], limit_mps_));
        }
        group_.lanes.push_back({from, to, plan_.turn_m, limit_mps_, static_cast<double>(plan_.sine), kAnySlot});
        group_.vehicles += to - from;
    }

    void stop_at(int slot, double place_m, int from, int to) {
        if (slot < from || slot >= to) return;
        const double room_m = place_m - v_.position_m[at(slot)];
        impose(slot, from,
               model_.meso ? stopping_speed_mps(model_, v_, slot, room_m)
                           : stop_at_line_mps2(model_.driver, v_.speed_mps[at(slot)], room_m));
    }

    void impose(int slot, int from, double asks) { group_.imposed.push_back({group_.vehicles + slot - from, asks}); }

    static constexpr int kAnySlot = std::numeric_limits<int>::max();

    const Model& model_;
    State& state_;
    const VehicleArrays& v_;
    int lane_;
    const LaneBlock& block_;
    const LanePlan& plan_;
    double limit_mps_;
    LaneGroup& group_;
};

}  // namespace

void add_lane(const Model& model, State& state, int lane, LaneGroup& group) {
    LaneAdder(model, state, lane, group).add();
}

}  // namespace stopline
