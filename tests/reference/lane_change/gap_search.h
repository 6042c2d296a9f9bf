// Speed adaptation for lane changes in the reference engine. A vehicle aligns its speed with a gap in the target lane,
// a follower there opens a gap, and a vehicle without a gap waits before the stop line. The rules are those of the
// comments in core/sim/lane_change/gap_search.cpp.
#pragma once

#include "reference/lane_change/request.h"

namespace stopline::reference_engine {

class GapSearch {
public:
    GapSearch(World& world, const Routes& routes)
        : w_(world), routes_(routes), gaps_(world), requests_(world, routes) {}

    // Sets Lane::alignments, and adds the yield stops of vehicles that wait for a gap.
    void search() {
        for (Lane& on : w_.lanes) on.alignments.clear();
        for (const std::size_t number : w_.order) {
            Lane& on = w_.lanes[number];
            if (on.left < 0 && on.right < 0) continue;
            for (Vehicle& v : on.vehicles) {
                if (v.next_lane >= 0 && v.preferred_offset == 0) continue;
                const Request me = requests_.of(v);
                if (me.to_line_m < -w_.driver(v).stop.margin_m) continue;
                if (me.required != 0) wait_for_gap(on, me);
                const Mandatory change = requests_.mandatory(me);
                if (change.changes != 0) align(on, me, change);
            }
        }
    }

private:
    static constexpr double kFallBack_mps = 3.0;
    static constexpr double kMinSpeed_mps = 1.0;
    static constexpr double kOpeningBraking_mps2 = 2.0;  // a vehicle that opens a gap must get by with this braking
    static constexpr double kPlannedOpening_mps2 = 1.5;  // but plans with this one

    void wait_for_gap(Lane& on, const Request& me) {
        const double place_m = requests_.waiting_position_m(me);
        const Vehicle& v = *me.vehicle;
        if (place_m - v.position_m <= decision_distance_m(w_.driver(v), v.speed_mps))
            on.add_yield_stop({v.index, place_m, -1});
    }

    // Returns the speed with which a vehicle gradually reaches a gap behind another one. It brakes with `braking_mps2`.
    double gap_reaching_mps(const Vehicle& v, double gap_m, double ahead_mps, double braking_mps2) const {
        constexpr double kTargetGapFactor = 1.1;
        const DriverSettings& driver = w_.driver(v);
        const double desired_m = w_.desired_gap_m(v.policy, std::min(v.speed_mps, ahead_mps));
        const double spare_m = gap_m - kTargetGapFactor * driver.lane_change.gap_share * desired_m;
        return std::max(krauss_speed_mps(braking_mps2, kLanding_s, spare_m, ahead_mps), ahead_mps - kFallBack_mps);
    }

    // Returns true if the lag gap is too short and does not grow by itself. Of two vehicles that want to swap lanes,
    // the one further upstream falls back.
    bool must_let_pass(const Lane& other, const Neighbour& follower, const Request& me, double urgency) {
        constexpr double kDroppingBack_mps = 0.5;
        const double own_mps = me.vehicle->speed_mps;
        if (follower.vehicle == nullptr || follower.speed_mps() + kDroppingBack_mps < own_mps) return false;
        const double share = requests_.gap_share(*me.vehicle, urgency);
        const double needed_m = gaps_.required_m(follower.vehicle->policy, follower.speed_mps(), own_mps, share);
        if (own_mps >= kMinSpeed_mps && follower.gap_m >= needed_m) return false;
        const bool wants_to_swap =
            follower.vehicle->lane == other.number &&
            me.required * requests_.of(w_.lane(other.number).vehicles[follower.vehicle->index]).required < 0;
        return !wants_to_swap;
    }

    // Returns the vehicle that opens a gap: the first of five that can brake gently enough; null if there is none. On
    // each approach, a queued vehicle opens a gap for one vehicle that has reached its waiting position, and for one
    // other.
    Neighbour gap_opener(const Lane& other, const Neighbour& follower, const Request& me, double urgency) const {
        constexpr std::size_t kMaxSearched = 5;
        const double own_mps = me.vehicle->speed_mps;
        if (follower.vehicle->lane != other.number) return {};
        const std::size_t first = follower.vehicle->index;
        const bool waiting = requests_.has_reached_waiting_position(me);
        for (std::size_t k = first; k < std::min(other.vehicles.size(), first + kMaxSearched); ++k) {
            const Vehicle& v = other.vehicles[k];
            if (w_.driver(v).lane_change.gap_opening != "on") continue;
            const double gap_m = follower.gap_m + follower.vehicle->position_m - v.position_m;
            const bool both_stand = own_mps < kMinSpeed_mps && v.speed_mps < kMinSpeed_mps;
            if (both_stand && (waiting ? v.let_in_waiting_tick : v.let_in_tick) > v.entry_tick) continue;
            const double share = requests_.gap_share(*me.vehicle, both_stand ? urgency : 1.0);
            const double needed_m = gaps_.required_m(v.policy, 0.0, 0.0, share);
            if (gap_m >= braking_m(v.speed_mps, own_mps, kOpeningBraking_mps2) + needed_m) return {&v, gap_m};
        }
        return {};
    }

    void align(Lane& on, const Request& me, const Mandatory& change) {
        Vehicle& v = *me.vehicle;
        const int number = change.changes < 0 ? on.left : on.right;
        if (number < 0) return;
        Lane& other = w_.lane(number);
        const double there_m = adjacent_position_m(on, v.position_m, other);
        if (there_m < v.length_m) return;
        const Neighbours there = gaps_.at(other, there_m, v.length_m, routes_.option(number, me.turn).route);
        double target_mps = kNoLimit;
        // A vehicle drives on beside a slow queue.
        if (there.leader.vehicle != nullptr && there.leader.speed_mps() > kFallBack_mps)
            target_mps =
                gap_reaching_mps(v, there.leader.gap_m, there.leader.speed_mps(), w_.driver(v).stop.deceleration_mps2);
        if (must_let_pass(other, there.follower, me, change.urgency())) {
            const Neighbour opener = gap_opener(other, there.follower, me, change.urgency());
            if (opener.vehicle != nullptr) {
                const double lowest_mps = v.speed_mps < kMinSpeed_mps ? 0.0 : kMinSpeed_mps;
                const double braking_mps2 =
                    std::min(kPlannedOpening_mps2, w_.driver(*opener.vehicle).stop.deceleration_mps2);
                add(other, *opener.vehicle,
                    std::max(gap_reaching_mps(*opener.vehicle, opener.gap_m, v.speed_mps, braking_mps2), lowest_mps));
            }
            if (opener.vehicle != there.follower.vehicle)
                target_mps = std::min(target_mps, std::max(there.follower.speed_mps() - kFallBack_mps, kMinSpeed_mps));
        }
        if (target_mps < v.speed_mps + 1.0) add(on, v, target_mps);
    }

    void add(Lane& on, const Vehicle& v, double target_mps) {
        on.alignments.push_back({v.index, target_mps});
        on.disturbed_tick = w_.tick;
        ++w_.situations.alignments;
    }

    World& w_;
    const Routes& routes_;
    LaneGaps gaps_;
    Requests requests_;
};

}  // namespace stopline::reference_engine
