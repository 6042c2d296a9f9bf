// What the first vehicle of a lane sees beyond it.
#include <algorithm>
#include <cmath>

#include "sim/phases.h"

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

constexpr double kFar_m = 1e9;

// Where movements part: the vehicle on any of them whose rear is still on the stretch where it is not clear of the others, if any. Only fronts
// that are further than `front_m` from the end of the lane.
class Parting {
public:
    Parting(const State& state, int lane, double front_m = kAll_m)
        : state_(state), v_(state.vehicles), end_m_(state.plan.lane(lane).length_m), front_m_(front_m) {
        for (const int next : state.plan.next(lane)) look_at(next);
    }
    // The one whose rear is the furthest back, and where that is, from the start of the lane.
    Ahead last() const { return found_; }
    double rear_m() const { return rear_m_; }

private:
    void look_at(int way) {
        const double clear_m = state_.plan.clear_m(way);
        const LaneBlock& block = state_.blocks[at(way)];
        for (int slot = block.last(); slot >= block.first; --slot) {
            if (!see(slot, 0.0, clear_m) || front_m_ == kAll_m) break;
        }
        if (!state_.plan.is_short(way)) return;
        const LanePlan& plan = state_.plan.lane(way);
        const LaneBlock& exit = state_.blocks[at(plan.exit)];
        for (int slot = std::max(exit.stop() - kReachBack, exit.first); slot < exit.stop(); ++slot) {
            if (v_.record[at(slot)].came_from == way) see(slot, plan.length_m, clear_m);
        }
    }

    // `start_m`: of its lane, from the end of the lane where the movements part. False: it is clear.
    bool see(int slot, double start_m, double clear_m) {
        const double front_m = start_m + v_.position_m[at(slot)];
        const double beyond_m = front_m - v_.length_m[at(slot)];
        if (beyond_m >= clear_m) return false;
        if (front_m <= front_m_ || end_m_ + beyond_m >= rear_m_) return true;
        rear_m_ = end_m_ + beyond_m;
        found_ = {slot, end_m_ + start_m};
        return true;
    }

    static constexpr double kAll_m = -1.0;
    static constexpr int kReachBack = 2;  // vehicles of a lane, over the one before it

    const State& state_;
    const VehicleArrays& v_;
    double end_m_;
    double front_m_;
    double rear_m_ = kFar_m;
    Ahead found_;
};

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
        const Ahead shared = Parting(state, at_lane).last();
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

// The last vehicle on the lanes of a route from the index-th one on, the start of which is `start_m` from that of the vehicle's own lane.
STOPLINE_INLINE Ahead last_on(const State& state, std::span<const int> route, std::size_t index, double start_m,
                              double position_m, double range_m) {
    for (std::size_t k = index; k < route.size(); ++k) {
        if (start_m - position_m > range_m) break;
        const LaneBlock& block = state.blocks[at(route[k])];
        if (block.count > 0) return {block.last(), start_m};
        start_m += state.plan.lane(route[k]).length_m;
    }
    return {};
}

// `own` has come to a lane of the route from another one, and its rear is not on the route yet: what stands here before that is nearer.
bool is_before_merging(const State& state, std::span<const int> route, const Ahead& own, const Ahead& beside) {
    if (beside.slot < 0) return false;
    const int came_from = state.vehicles.record[at(own.slot)].came_from;
    return came_from >= 0 && std::find(route.begin(), route.end(), came_from) == route.end();
}

// On the route. `hidden`: the last vehicle on its lanes where one that goes another way is nearer. Once a lane and step: inlined.
STOPLINE_INLINE Ahead ahead_on_route(const State& state, int lane, double position_m, int route_number, int index,
                                     double range_m, Ahead* hidden = nullptr) {
    const VehicleArrays& v = state.vehicles;
    const LanePlan& here = state.plan.lane(lane);
    if (!here.branches && here.length_m - position_m > range_m) return {};
    Ahead beside;
    double beside_rear_m = kFar_m;
    const std::span<const int> route = state.plan.route(route_number);
    const bool ends_here = at(index) + 1 == route.size();  // where others go on
    if (here.branches || ends_here) {
        const Parting parting(state, lane);
        beside = parting.last();
        beside_rear_m = parting.rear_m();
    } else if (here.origin >= 0 && position_m < state.plan.clear_m(lane)) {
        const double origin_m = state.plan.lane(here.origin).length_m;
        const Parting parting(state, here.origin, position_m);
        beside = {parting.last().slot, parting.last().start_m - origin_m};
        beside_rear_m = parting.rear_m() - origin_m;
    }
    const Ahead own = last_on(state, route, at(index) + 1, here.length_m, position_m, range_m);
    if (own.slot >= 0) {
        double rear_m = own.start_m + v.position_m[at(own.slot)] - v.length_m[at(own.slot)];
        if (rear_m < own.start_m && is_before_merging(state, route, own, beside)) rear_m = own.start_m;
        if (rear_m <= beside_rear_m) return own;
        if (hidden != nullptr && own.slot != beside.slot) *hidden = own;
    }
    return beside;
}

}  // namespace

namespace {

STOPLINE_INLINE Ahead ahead_of(const State& state, int lane, int slot, double range_m, Ahead* hidden = nullptr) {
    if (state.vehicles.next_lane[at(slot)] < 0) {  // it leaves, or waits for a gap: it sees who still reaches back
        return Parting(state, lane).last();
    }
    const VehicleRecord& record = state.vehicles.record[at(slot)];
    const double position_m = state.vehicles.position_m[at(slot)];
    const Ahead seen = ahead_on_route(state, lane, position_m, record.route, record.route_index, range_m, hidden);
    if (seen.slot >= 0 || record.trip < 0) return seen;
    const OnTrip on_trip{record.route, record.route_index, record.trip, record.leg};
    return ahead_on_trip(state, lane, position_m, on_trip, range_m);
}

}  // namespace

Ahead vehicle_ahead(const State& state, int lane, int slot, double range_m) {
    return ahead_of(state, lane, slot, range_m);
}

Ahead vehicle_ahead(const State& state, int lane, double position_m, const OnTrip& on_trip, double range_m) {
    const Ahead seen = vehicle_ahead(state, lane, position_m, on_trip.route, on_trip.route_index, range_m);
    if (seen.slot >= 0 || on_trip.trip < 0) return seen;
    return ahead_on_trip(state, lane, position_m, on_trip, range_m);
}

Ahead last_on_way(const State& state, int lane, int slot, double range_m) {
    const VehicleRecord& record = state.vehicles.record[at(slot)];
    return last_on(state, state.plan.route(record.route), at(record.route_index) + 1, state.plan.lane(lane).length_m,
                   state.vehicles.position_m[at(slot)], range_m);
}

Ahead vehicle_ahead(const State& state, int lane, double position_m, int route, int index, double range_m) {
    return ahead_on_route(state, lane, position_m, route, index, range_m);
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

bool comes_by_another_way(const State& state, int lane, int slot, int ahead) {
    const VehicleArrays& v = state.vehicles;
    const VehicleRecord& other = v.record[at(ahead)];
    double rear_m = v.position_m[at(ahead)] - static_cast<double>(v.length_m[at(ahead)]);
    if (rear_m >= 0.0) return false;
    const std::span<const int> route = state.plan.route(v.record[at(slot)].route);
    const auto is_own = [&](int way) { return std::find(route.begin(), route.end(), way) != route.end(); };
    if (other.came_from >= 0 && state.plan.lane(other.came_from).origin == lane) return false;  // parts here
    if (other.came_from >= 0 && !is_own(other.came_from)) return true;
    // Over an edge that is shorter than the vehicle.
    if (other.came_from >= 0) rear_m += state.plan.lane(other.came_from).length_m;
    return rear_m < 0.0 && other.came_by >= 0 && !is_own(other.came_by);
}

void look_beyond_lanes(const Model& model, State& state, NetworkPart& part) {
    constexpr double kNothing_m = 1e6;
    constexpr double kTouch_m = 1e-4;  // against rounding
    VehicleArrays& v = state.vehicles;
    part.minding.clear();
    for (const int lane : part.awake) {
        fetch_on(state, part.fetching);
        const int head = state.blocks[at(lane)].first;
        const std::size_t sentinel = at(head - 1);
        Ahead hidden;
        const Ahead ahead = ahead_of(state, lane, head, model.driver.cacc.radar_range_m, &hidden);
        const bool seen = ahead.slot >= 0;
        const std::size_t other = at(seen ? ahead.slot : head);
        v.position_m[sentinel] = seen ? ahead.start_m + v.position_m[other] : kNothing_m;
        v.speed_mps[sentinel] = v.speed_mps[other];
        v.length_m[sentinel] = v.length_m[other];
        v.acceleration_mps2[sentinel] = seen ? v.acceleration_mps2[other] : 0.0F;
        if (const double reach_m = v.position_m[sentinel] - v.position_m[at(head)];
            seen && reach_m < v.length_m[sentinel] && comes_by_another_way(state, lane, head, ahead.slot)) {
            v.length_m[sentinel] = static_cast<float>(std::max(reach_m - kTouch_m, 0.0));
        }
        const double rear_m = v.position_m[sentinel] - v.length_m[sentinel];
        // The mesoscale mode counts with all others (meso_kernels.h).
        if (!model.meso && seen && rear_m < v.position_m[at(head)]) {
            ++part.violations.overlaps;
            part.violations.see({model.time_s(state.tick), Sighting::Kind::overlap, lane, v.id[at(head)], v.id[other]});
        }
        if (v.has_powertrain()) {
            hear(state, sentinel, other, seen);
            look_past(model, state, lane, hidden, part);
        }
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
