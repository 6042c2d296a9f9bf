// The lane changes that a vehicle wants in the reference engine, and how urgent they are. The rules are those of the
// comments in core/sim/lane_change/lane_change.h.
#pragma once

#include "reference/lane_change/neighbours.h"

namespace stopline::reference_engine {

inline double adjacent_position_m(const Lane& from, double front_m, const Lane& to) {
    return front_m + from.start_offset_m - to.start_offset_m;
}

// A vehicle that may change lanes, and the changes that it wants.
struct Request {
    Vehicle* vehicle = nullptr;
    Turn turn = Turn::none;
    int required = 0;                  // lane changes before the stop line; below 0: to the left
    double to_line_m = 0.0;            // distance to the stopping position before the line
    double pocket_entry_m = kNoLimit;  // front position from which the needed pocket is beside the whole vehicle
    int preferred = 0;                 // lane changes that suit later turns
    double to_preferred_line_m = 0.0;
};

// A change for which the vehicle looks for a gap now.
struct Mandatory {
    int changes = 0;  // below 0: to the left; 0: none is due
    double usable_m = 0.0;
    double look_ahead_m = 1.0;

    // 0 where the search begins, 1 where no distance is left.
    double urgency() const { return std::clamp(1.0 - usable_m / look_ahead_m, 0.0, 1.0); }
};

class Requests {
public:
    Requests(World& world, const Routes& routes) : w_(world), routes_(routes) {}

    Request of(Vehicle& v) const {
        const Lane& on = w_.lane_of(v);
        Request me;
        me.vehicle = &v;
        me.turn = routes_.turn_of(v.route);
        me.required = routes_.option(on.number, me.turn).lane_changes;
        me.to_line_m = on.stop_line_m - w_.driver(v).stop.margin_m - v.position_m;
        if (me.required != 0) {
            const Lane* const target = lane_after(on, me.required);
            const double start_m = target == nullptr ? 0.0 : adjacent_position_m(*target, 0.0, on);
            if (start_m > 0.0) me.pocket_entry_m = start_m + v.length_m + kBesidePocket_m;
            return me;
        }
        me.preferred = v.preferred_offset;
        if (me.preferred == 0) return me;
        const auto to_line_m = [&](const Lane& lane) { return lane.start_offset_m + lane.stop_line_m; };
        const Lane& exit = w_.lane(w_.route_of(v.route).back());
        me.to_preferred_line_m = me.to_line_m + to_line_m(exit);
        if (v.preferred_for_third) {
            const int route = routes_.route_on_approach(exit.approach, v.following_turn);
            me.to_preferred_line_m += to_line_m(w_.lane(w_.route_of(route).back()));
        }
        return me;
    }

    Mandatory mandatory(const Request& me) const {
        Mandatory change;
        change.changes = me.required != 0 ? me.required : me.preferred;
        if (change.changes == 0) return change;
        change.look_ahead_m = look_ahead_m(*me.vehicle, change.changes);
        const double distance_m = me.required != 0 ? me.to_line_m : me.to_preferred_line_m;
        change.usable_m =
            std::min(distance_m - queue_ahead_m(me, change.changes), me.pocket_entry_m - me.vehicle->position_m);
        if (change.usable_m >= change.look_ahead_m) change.changes = 0;
        return change;
    }

    // Returns the share of the policy's gap that a mandatory change requires.
    double gap_share(const Vehicle& v, double urgency) const {
        const LaneChangeSettings& s = w_.driver(v).lane_change;
        return s.gap_share + urgency * (s.urgent_gap_share - s.gap_share);
    }

    // Returns the usable distance below which a vehicle looks for a gap for `changes` lane changes.
    double look_ahead_m(const Vehicle& v, int changes) const {
        const LaneChangeSettings& s = w_.driver(v).lane_change;
        const double time_s = s.look_ahead_s * std::abs(changes) * (changes < 0 ? s.left_factor : 1.0);
        return v.remembered_mps * time_s + 2.0 * (v.length_m + w_.kind(v).policy.settings.standstill_gap_m);
    }

    // Returns the position where a vehicle waits before the stop line for a gap in the adjacent lane.
    double waiting_position_m(const Request& me) const {
        const Vehicle& v = *me.vehicle;
        const Lane& on = w_.lane_of(v);
        const Lane& other = w_.lane(me.required < 0 ? on.left : on.right);
        const double spacing_m = v.length_m + 2.0 * w_.kind(v).standstill_gap_m;
        const double line_m = on.stop_line_m - w_.driver(v).stop.margin_m;
        const double start_m = adjacent_position_m(other, 0.0, on) + v.length_m + kBesidePocket_m;
        // Left-bound vehicles wait nearer to the line than right-bound ones.
        const double beside_m = std::min(std::max(line_m - (me.required < 0 ? 0.0 : spacing_m), start_m), line_m);
        if (me.pocket_entry_m == kNoLimit) return beside_m;
        if (std::abs(me.required) == 1) return std::min(beside_m, behind_pocket_queue_m(v, other));
        return v.position_m <= me.pocket_entry_m ? std::min(beside_m, me.pocket_entry_m) : beside_m;
    }

    // Returns true if the vehicle is slow and less than 2 m upstream of its waiting position, or has passed it.
    bool has_reached_waiting_position(const Request& me) const {
        return me.required != 0 && me.vehicle->is_slow() && waiting_position_m(me) - me.vehicle->position_m < 2.0;
    }

    // Returns the lane after a number of lane changes; null if there is none.
    const Lane* lane_after(const Lane& from, int changes) const {
        int number = from.number;
        for (int k = 0; k < std::abs(changes) && number >= 0; ++k)
            number = changes < 0 ? w_.lane(number).left : w_.lane(number).right;
        return number < 0 ? nullptr : &w_.lane(number);
    }

private:
    static constexpr double kBesidePocket_m = 1.0;

    // Returns the length that the vehicles ahead on the target lane would have as a standing queue.
    double queue_ahead_m(const Request& me, int changes) const {
        const Vehicle& v = *me.vehicle;
        const Lane& on = w_.lane_of(v);
        const Lane* const target = lane_after(on, changes);
        if (target == nullptr) return 0.0;
        const auto vehicles = LaneGaps::vehicles_ahead(*target, adjacent_position_m(on, v.position_m, *target));
        return static_cast<double>(vehicles) * w_.longest_space_m();
    }

    // Returns the position one standstill gap behind the queue in a pocket; infinity if there is none ahead.
    double behind_pocket_queue_m(const Vehicle& v, const Lane& pocket) const {
        if (pocket.vehicles.empty()) return kNoLimit;
        const Vehicle& last = pocket.vehicles.back();
        const double front_m = last.position_m + comfortable_braking_m(w_.driver(last), last.speed_mps);
        const double rear_m = adjacent_position_m(pocket, front_m, w_.lane_of(v)) - last.length_m;
        return v.position_m < rear_m ? std::max(rear_m - w_.kind(v).standstill_gap_m, v.position_m) : kNoLimit;
    }

    World& w_;
    const Routes& routes_;
};

}  // namespace stopline::reference_engine
