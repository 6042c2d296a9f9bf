// Vehicles that must change lanes: near the stop line they adapt their speed to the gaps in the lane beside, and at last they wait.
#include <algorithm>
#include <cmath>

#include "base/arithmetic.h"
#include "driver/krauss.h"
#include "sim/lane_change.h"
#include "sim/phases.h"

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

// Slower than the vehicle beside by this, to fall behind it.
constexpr double kFallBack_mps = 3.0;
constexpr double kCrawl_mps = 1.0;
constexpr double kAimed = 1.1;          // times the gap that is needed: what one comes near to slowly is never reached
constexpr double kFallsBack_mps = 0.5;  // a vehicle slower than this one by more

class Waiting {
public:
    Waiting(const Model& model, State& state, NetworkPart& part, int lane)
        : model_(model), state_(state), v_(state.vehicles), part_(part), lane_(lane) {}

    void look() {
        const LaneBlock& block = state_.blocks[at(lane_)];
        for (int slot = block.first; slot < block.stop(); ++slot) {
            if (v_.next_lane[at(slot)] >= 0 && v_.record[at(slot)].turn_after == Turn::none) continue;
            const Changer me = changer_at(model_, state_, lane_, slot);
            if (me.to_line_m < -model_.driver.stop.margin_m) continue;
            const double urgent_m = model_.lane_change.urgent_m;
            if (me.changes != 0 && me.to_line_m < urgent_m * std::abs(me.changes)) {
                hold(me);
                adapt(me, me.changes, me.to_line_m);
            } else if (me.wished != 0 && me.to_next_line_m < urgent_m * std::abs(me.wished)) {
                adapt(me, me.wished, me.to_next_line_m);
            }
        }
    }

private:
    void hold(const Changer& me) {
        const double place_m = waiting_place_m(model_, state_, me);
        if (place_m - me.front_m > decides_within_m(model_, me.speed_mps)) return;
        stopline::hold(state_, part_, lane_, {me.slot, place_m, -1, false});
    }

    // The speed at which one comes to follow another vehicle, not much slower than it meanwhile.
    double following_mps(const Neighbour& ahead, int policy, double speed_mps) const {
        const double b = model_.driver.stop.deceleration_mps2;
        const double share = kAimed * model_.lane_change.gap_share;
        const double room_m = ahead.gap_m - share * desired_gap_m(model_, policy, std::min(speed_mps, ahead.speed_mps));
        return std::max(braking_speed_mps(b, kLandingTime_s, room_m, ahead.speed_mps), ahead.speed_mps - kFallBack_mps);
    }

    // The vehicle on the other lane wants to this one: it falls back behind who is ahead.
    bool wants_here(int other, int slot, const Changer& me) const {
        const LaneBlock& block = state_.blocks[at(other)];
        if (slot < block.first || slot >= block.stop()) return false;
        return me.changes * changer_at(model_, state_, other, slot).changes < 0;
    }

    bool must_let_pass(int other, const Neighbour& behind, const Changer& me, double to_line_m) const {
        if (behind.slot < 0 || behind.speed_mps + kFallsBack_mps < me.speed_mps) return false;
        const double share = urgent_share(model_, to_line_m);
        const double needed_m = needed_gap_m(model_, behind.policy, behind.speed_mps, me.speed_mps, share);
        return behind.gap_m < needed_m && !wants_here(other, behind.slot, me);
    }

    // It is on the lane itself, and braking comfortably to my speed is enough not to reach me.
    bool may_help(int other, const Neighbour& behind, const Changer& me) const {
        const LaneBlock& block = state_.blocks[at(other)];
        const double braking_m =
            0.5 * std::max(square(behind.speed_mps) - square(me.speed_mps), 0.0) / model_.driver.stop.deceleration_mps2;
        return model_.lane_change.help == "on" && behind.slot >= block.first && behind.slot < block.stop() &&
               std::max(behind.gap_m, 0.0) >= braking_m;
    }

    // Signed as WayOn::changes; how far it is to the stop line for which they are made.
    void adapt(const Changer& me, int changes, double to_line_m) {
        const BesidePlan& beside = state_.plan.beside(lane_);
        const int other = changes < 0 ? beside.left : beside.right;
        if (other < 0) return;
        const double there_m = beside_m(state_, lane_, me.front_m, other);
        if (there_m < me.length_m) return;
        const Around there = around(model_, state_, other, there_m, me.length_m, beside_route(other, me));
        double most_mps = kAnySpeed_mps;
        // Along a queue that stands it drives on.
        if (there.ahead.slot >= 0 && there.ahead.speed_mps > kFallBack_mps) {
            most_mps = following_mps(there.ahead, me.policy, me.speed_mps);
        }
        const Neighbour& behind = there.behind;
        if (must_let_pass(other, behind, me, to_line_m)) {
            if (may_help(other, behind, me)) {
                const Neighbour mine{me.slot, behind.gap_m, me.speed_mps, me.policy};
                note(other, {behind.slot, std::max(following_mps(mine, behind.policy, behind.speed_mps), kCrawl_mps)});
            } else {
                most_mps = std::min(most_mps, std::max(behind.speed_mps - kFallBack_mps, kCrawl_mps));
            }
        }
        if (most_mps < me.speed_mps + 1.0) note(lane_, {me.slot, most_mps});
    }

    int beside_route(int other, const Changer& me) const { return state_.plan.beside(other).way(me.turn).route; }

    void note(int lane, const Adapting& adapting) {
        std::vector<Adapting>& all = state_.adapting[at(lane)];
        if (all.empty()) part_.adapting.push_back(lane);
        all.push_back(adapting);
        state_.resting[at(lane)].imposed = state_.tick;
    }

    const Model& model_;
    State& state_;
    const VehicleArrays& v_;
    NetworkPart& part_;
    int lane_;
};

}  // namespace

void wait_to_change(const Model& model, State& state, NetworkPart& part) {
    if (state.plan.changing().empty()) return;
    for (const int lane : part.adapting) state.adapting[at(lane)].clear();
    part.adapting.clear();
    for (const int lane : part.occupied) {
        if (state.plan.beside(lane).changes()) Waiting(model, state, part, lane).look();
    }
}

}  // namespace stopline
