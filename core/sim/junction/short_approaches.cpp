#include "sim/junction/short_approaches.h"

#include <algorithm>
#include <span>

#include "base/containers/index.h"
#include "base/speed_thresholds.h"
#include "sim/clearing/keep_clear.h"
#include "sim/junction/candidate.h"
#include "sim/junction/stop_lines.h"
#include "sim/state/queries/stopping_distance.h"

namespace stopline {

namespace {

// Finds the place where the vehicle in `slot` must be able to stop beyond its lane.
class StopSearch {
public:
    StopSearch(const Model& model, const State& state, int lane, int slot)
        : model_(model),
          state_(state),
          v_(state.vehicles),
          driver_(model.driver_of(v_.policy[at(slot)])),
          range_m_(decision_distance_m(driver_, v_.speed_mps[at(slot)])),
          lane_(lane),
          slot_(slot) {}

    // Returns the place, m from the start of the vehicle's lane; kNoWait_m: none within the decision distance.
    // Precondition: the vehicle has a next lane.
    double find() const {
        const VehicleRecord& record = v_.record[at(slot_)];
        const Itinerary itinerary = v_.itinerary_of(at(slot_));
        if (!itinerary.has_trip()) return kNoWait_m;
        const double last_m = v_.position_m[at(slot_)] + range_m_;
        std::span<const int> route = state_.plan.route(record.route);
        std::size_t k = at(record.route_index) + 1;
        double start_m = state_.plan.lane(lane_).length_m;
        for (int edge = itinerary.trip_edge + 1; start_m <= last_m; ++edge) {
            for (; k + 1 < route.size(); ++k) start_m += state_.plan.lane(route[k]).length_m;
            const int approach = route.back();
            const Turn turn = state_.plan.turn_of_trip(itinerary.trip, edge);
            const int first = turn == Turn::none ? -1 : state_.plan.adjacent(approach).turn_option(turn).route;
            if (first < 0) return kNoWait_m;
            double stop_m = kNoWait_m;
            for (int next = first; next >= 0; next = state_.plan.next_parallel_route(next))
                stop_m = std::min(stop_m, stop_on_approach_m(approach, state_.plan.route(next)[1], start_m));
            if (start_m + stop_m <= last_m) return start_m + stop_m;
            start_m += state_.plan.lane(approach).length_m;
            route = state_.plan.route(first);
            k = 1;
        }
        return kNoWait_m;
    }

private:
    // Returns the first place where a vehicle that will take `connection` must be able to stop, m from the start of the
    // approach lane; kNoWait_m: none. `start_m`: start of the approach lane, from the start of the vehicle's lane.
    double stop_on_approach_m(int approach, int connection, double start_m) const {
        const LanePlan& plan = state_.plan.lane(approach);
        const double line_m = plan.stop_line_m - driver_.tables.stop.margin_m;
        if (state_.plan.stop_rule(connection) != StopRule::none || stops_for_signal(approach, connection, start_m))
            return on_lane_m(line_m, plan.stop_line_m);
        for (const Conflict& conflict : state_.plan.conflicts(connection)) {
            if (!conflict.yields && !is_occupied(conflict)) continue;
            const double area_m = plan.length_m + conflict.from_m;
            double wait_m = area_m - driver_.give_way.margin_m;
            if (!state_.plan.may_wait_inside(connection)) wait_m = std::min(wait_m, line_m);
            return on_lane_m(wait_m, area_m);
        }
        return kNoWait_m;
    }

    // Returns true if the signal of the connection is not green and the vehicle can still stop at the stop line.
    bool stops_for_signal(int approach, int connection, double start_m) const {
        const LanePlan& plan = state_.plan.lane(approach);
        if (plan.signal_group < 0) return false;
        const Light light = state_.signals.lights[at(state_.plan.signal_group_for(approach, connection))];
        return light != Light::green && can_stop_for_signal(model_, v_, slot_, start_m + plan.stop_line_m, light);
    }

    // Returns the waiting position, but at least half the way from the start of the approach lane to `end_m`, the place
    // that the vehicle must not pass.
    static double on_lane_m(double wait_m, double end_m) {
        constexpr double kOnLane_m = 0.05;  // smallest result, so that the vehicle reaches the lane in finite time
        return std::max({wait_m, 0.5 * end_m, kOnLane_m});
    }

    // Number of last vehicles on an exit lane that are checked, because their rears may still be on the connection.
    static constexpr int kReachBack = 2;

    // Returns true if a vehicle that takes connection `conflict.other` is in the conflict area.
    bool is_occupied(const Conflict& conflict) const {
        const auto is_in_area = [&](int slot, double offset_m) {
            const double front_m = v_.position_m[at(slot)] + offset_m;
            return front_m > conflict.other_from_m &&
                   front_m - static_cast<double>(v_.length_m[at(slot)]) < conflict.other_to_m;
        };
        const LaneBlock& inner = state_.blocks[at(conflict.other)];
        for (int slot = inner.first; slot < inner.past_last(); ++slot) {
            if (is_in_area(slot, 0.0)) return true;
        }
        const LanePlan& other = state_.plan.lane(conflict.other);
        if (conflict.other_from_m < 0.0) {
            const double origin_m = state_.plan.lane(other.origin).length_m;
            const LaneBlock& origin = state_.blocks[at(other.origin)];
            for (int slot = origin.first; slot < origin.past_last(); ++slot) {
                if (v_.position_m[at(slot)] - origin_m <= conflict.other_from_m) break;
                if (v_.next_lane[at(slot)] == conflict.other && is_in_area(slot, -origin_m)) return true;
            }
        }
        const LaneBlock& exit = state_.blocks[at(other.exit)];
        for (int slot = std::max(exit.first, exit.past_last() - kReachBack); slot < exit.past_last(); ++slot) {
            if (v_.record[at(slot)].previous_lane == conflict.other && is_in_area(slot, other.length_m)) return true;
        }
        return false;
    }

    const Model& model_;
    const State& state_;
    const VehicleArrays& v_;
    const DriverPlan& driver_;
    double range_m_;
    int lane_;
    int slot_;
};

// Returns the position of the stop line of the approach lane that a vehicle on `lane` reaches next, m from the start of
// `lane`. `next`: the next lane of the vehicle. StopSearch finds no place that is more than one margin upstream
// of this line.
double next_line_m(const State& state, int lane, int next) {
    const LanePlan& next_plan = state.plan.lane(next);
    const bool is_connection = next_plan.origin >= 0;
    const double start_m = state.plan.lane(lane).length_m + (is_connection ? next_plan.length_m : 0.0);
    return start_m + state.plan.lane(is_connection ? next_plan.exit : next).next_limit_m;
}

}  // namespace

void stop_before_short_approaches(const Model& model, State& state, Partition& part) {
    if (!model.is_imported()) return;
    const VehicleArrays& v = state.vehicles;
    for (const int lane : part.awake) {
        const LaneBlock& block = state.blocks[at(lane)];
        int next = -1;
        double line_m = kNoWait_m;
        for (int slot = block.first; slot < block.past_last(); ++slot) {
            const double speed_mps = v.speed_mps[at(slot)];
            if (speed_mps < kStoppedSpeed_mps) break;  // its followers cannot reach the approach lane before it
            const DriverPlan& driver = model.driver_of(v.policy[at(slot)]);
            const double range_m = decision_distance_m(driver, speed_mps);
            if (state.plan.lane(lane).length_m - v.position_m[at(slot)] > range_m) break;
            if (v.next_lane[at(slot)] < 0) continue;
            if (v.next_lane[at(slot)] != next) {
                next = v.next_lane[at(slot)];
                line_m = next_line_m(state, lane, next);
            }
            const double margin_m = std::max(driver.tables.stop.margin_m, driver.give_way.margin_m);
            if (line_m - margin_m - v.position_m[at(slot)] > range_m) continue;
            const double place_m = StopSearch(model, state, lane, slot).find();
            if (place_m < kNoWait_m)
                add_yield_stop(state.junctions, part, lane, {slot, place_m, -1, YieldReason::priority});
        }
    }
}

}  // namespace stopline
