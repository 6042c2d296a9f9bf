#include "sim/lane_change/gap_cooperation.h"

#include <algorithm>
#include <cmath>

#include "base/containers/index.h"
#include "base/simd/arithmetic.h"
#include "base/speed_thresholds.h"
#include "driver/following_model.h"
#include "sim/lane_change/preferred_lane.h"
#include "sim/perception/lane_gaps.h"
#include "sim/state/lane_blocks.h"
#include "sim/state/queries/desired_gap.h"
#include "sim/state/queries/gap.h"
#include "sim/state/queries/received_message.h"
#include "sim/state/queries/stopping_distance.h"
#include "sim/state/queries/vehicle_place.h"

namespace stopline {

namespace {

// All values are our choice.
constexpr double kSearchInterval_s = 1.0;  // between two searches for an opener
constexpr double kRange_m = 30.0;          // largest distance between a requester and its opener
constexpr double kOpening_mps = 1.5;       // a gap grows with this speed
constexpr double kOpeningRamp_mps2 = 1.0;  // change of the opener's speed
constexpr double kFallingBack_mps = 3.0;   // largest speed difference of a requester to the leader of its gap
constexpr double kApproach_s = 2.0;        // time constant with which a requester approaches its place
constexpr double kDischarge_mps = 8.3;     // converts the length that a gap lacks to delay in a discharging queue
constexpr double kSlow_mps = 3.0;          // a queue is slower than this speed
constexpr double kTimeLimit_s = 10.0;      // an agreement is cancelled if it holds back a vehicle for longer
constexpr double kPause_s = 5.0;           // time from the cancellation to the next agreement
constexpr double kReached_m = 0.3;         // a gap is open if it lacks less than this
constexpr double kSilence_s = 1.0;         // an agreement ends if a vehicle hears nothing from the other for so long
constexpr int kLostMessages = 3;           // and has missed at least so many messages
constexpr int kFollowersPerOpener = 4;     // at most one opener in this number of consecutive vehicles

class LaneRequests {
public:
    LaneRequests(const Model& model, State& state, Partition& part, int lane)
        : model_(model),
          state_(state),
          v_(state.vehicles),
          cooperation_(state.gap_cooperation),
          part_(part),
          lane_(lane),
          block_(state.blocks[at(lane)]),
          requests_(state.gap_cooperation.requests[at(lane)]) {}

    void run() {
        if (state_.tick % cooperation_.search_ticks == 0) add_requests();
        std::size_t kept = 0;
        for (GapRequest& request : requests_) {
            if (keep(request)) requests_[kept++] = request;
        }
        requests_.resize(kept);
    }

private:
    double length_m(int slot) const { return v_.length_m[at(slot)]; }
    bool cooperates(int slot) const { return cooperation_.cooperates[at(v_.policy[at(slot)])] != 0; }

    int target_of(const MandatoryChange& change) const {
        const AdjacentLanes& adjacent = state_.plan.adjacent(lane_);
        return change.lane_changes == 0 ? -1 : change.lane_changes < 0 ? adjacent.left : adjacent.right;
    }

    bool is_past_line(const LaneChangeRequest& me) const {
        return me.to_line_m < -model_.driver_of(me.policy).tables.stop.margin_m;
    }

    void add_requests() {
        for (int slot = block_.first; slot < block_.past_last(); ++slot) {
            if (!cooperates(slot) || v_.record[at(slot)].route < 0) continue;
            if (v_.next_lane[at(slot)] >= 0) continue;
            const int id = v_.id[at(slot)];
            if (std::any_of(requests_.begin(), requests_.end(), [=](const auto& r) { return r.requester == id; }))
                continue;
            const LaneChangeRequest me = lane_change_request(model_, state_, lane_, slot);
            if (me.lane_changes == 0) continue;  // a change for a later turn can wait
            const int target = target_of(mandatory_change(model_, state_, me));
            if (target < 0 || is_past_line(me)) continue;
            GapRequest request;
            request.requester = id;
            request.place = slot - block_.first;
            request.target_lane = target;
            request.since_tick = state_.tick;
            requests_.push_back(request);
            ++part_.gap_counts.requested;
        }
    }

    // Returns false if the request has ended.
    bool keep(GapRequest& r) {
        const int slot = slot_on_lane(state_, lane_, r.requester, r.place);
        if (slot < 0) return end_of_departed(r);
        r.place = slot - block_.first;
        const LaneChangeRequest me = lane_change_request(model_, state_, lane_, slot);
        const MandatoryChange change = mandatory_change(model_, state_, me);
        if (target_of(change) != r.target_lane || is_past_line(me)) {
            if (r.agreed()) end(r, GapEnding::not_needed, 0.0);
            return false;
        }
        front_on_target_m_ = adjacent_position_m(state_, lane_, me.front_m, r.target_lane);
        // A requester at its waiting position needs no agreement. A vehicle of the target lane holds the gap open
        // without a time limit (gap_search.cpp).
        const bool waits = has_reached_waiting_position(model_, state_, me);
        if (waits && r.agreed()) {
            end(r, GapEnding::stopped, 0.0);
            return true;
        }
        if (r.agreed()) keep_opening(r, me);
        const bool searches = state_.tick % cooperation_.search_ticks == 0 && state_.tick >= r.next_search_tick;
        if (!r.agreed() && searches && !waits && front_on_target_m_ >= me.length_m) search(r, me);
        return true;
    }

    // Counts the outcome of a request whose vehicle has left the lane. Returns false.
    bool end_of_departed(const GapRequest& r) {
        if (!r.agreed()) return false;
        const LaneBlock& target = state_.blocks[at(r.target_lane)];
        const int slot = slot_on_lane(state_, r.target_lane, r.requester, 0);
        const bool is_used = slot >= 0 && target.has(slot + 1) && v_.id[at(slot + 1)] == r.opener;
        ++part_.gap_counts.of(is_used ? GapEnding::used : GapEnding::not_needed);
        return false;
    }

    // Ends an agreement. The requester looks for the next opener after `pause_s`.
    void end(GapRequest& r, GapEnding ending, double pause_s = 0.0) {
        ++part_.gap_counts.of(ending);
        r.opener = r.leader = -1;
        r.begin_tick = r.agreed_tick = -1;
        r.is_open = r.is_confirmed = false;
        r.next_search_tick = state_.tick + to_ticks(pause_s, model_.step_s);
    }

    bool is_late(const GapRequest& r) const {
        return r.begin_tick >= 0 && model_.time_s(state_.tick - r.begin_tick) > kTimeLimit_s;
    }

    // A possible place of the requester ahead of the vehicle in slot `opener` of the target lane.
    struct Place {
        int opener = -1;
        int leader = -1;          // slot of the vehicle ahead of the place; -1: none on the lane
        double leader_mps = 0.0;  // speed of the leader; without leader, that of the requester
        double gap_m = 0.0;       // present gap ahead of the opener
        double missing_m = 0.0;   // length that the gap lacks
        double extra_m = 0.0;     // further length needed, because the requester is beside the opener
        double spare_m = 0.0;     // distance from the requester to its place; below 0: it must fall back
    };

    Place place_ahead_of(const LaneChangeRequest& me, int target_lane, int opener, double front_m) const {
        constexpr double kFreeLane_m = 1e3;  // without leader: longer than any gap that a requester needs
        Place place{.opener = opener};
        const bool has_leader = opener > state_.blocks[at(target_lane)].first;
        if (has_leader) place.leader = opener - 1;
        place.leader_mps = has_leader ? v_.speed_mps[at(place.leader)] : me.speed_mps;
        const double opener_gap_m = desired_gap_m(model_, v_.policy[at(opener)], place.leader_mps);
        const double own_gap_m = desired_gap_m(model_, me.policy, place.leader_mps);
        place.gap_m = has_leader ? net_gap_m(v_, place.leader, opener) : kFreeLane_m;
        place.spare_m = has_leader ? rear_m(v_, place.leader) - own_gap_m - front_m : kFreeLane_m;
        const double room_m = own_gap_m + me.length_m + opener_gap_m;
        // A requester beside the opener does not fall back. So the opener falls back until it is behind the requester.
        place.missing_m = room_m - place.gap_m;
        const double behind_requester_m = v_.position_m[at(opener)] + opener_gap_m + me.length_m - front_m;
        place.extra_m = std::max(behind_requester_m - std::max(place.missing_m, 0.0), 0.0);
        return place;
    }

    // Return the tick at which the newest message that has arrived was sent. request_tick(): from the requester to
    // `other`. answer_tick(): from `other` to the requester.
    std::int64_t request_tick(const GapRequest& r, const LaneChangeRequest& me, int other) const {
        return heard_tick({me.slot, other, r.target_lane, std::abs(front_on_target_m_ - v_.position_m[at(other)])});
    }
    std::int64_t answer_tick(const LaneChangeRequest& me, int other) const {
        return heard_tick({other, me.slot, lane_, std::abs(front_on_target_m_ - v_.position_m[at(other)])});
    }
    std::int64_t heard_tick(const MessageLink& link) const {
        if (!uses_channel(model_)) return state_.tick;
        return newest_message_tick(model_, state_, link, cooperation_.longest_age_ticks);
    }

    void keep_opening(GapRequest& r, const LaneChangeRequest& me) {
        const int opener = slot_on_lane(state_, r.target_lane, r.opener, r.place);
        if (opener < 0) return end(r, GapEnding::left);
        const std::int64_t answered_tick = answer_tick(me, opener);
        if (answered_tick == kNoMessage || request_tick(r, me, opener) == kNoMessage)
            return end(r, GapEnding::lost, kPause_s);
        r.is_confirmed = r.is_confirmed || answered_tick >= r.agreed_tick;
        if (is_late(r)) return end(r, GapEnding::expired, kPause_s);
        if (opener == state_.stop_lines.stop_slot[at(r.target_lane)]) return end(r, GapEnding::stopped);
        Place place = place_ahead_of(me, r.target_lane, opener, front_on_target_m_);
        place.missing_m += r.extra_m;
        if (is_taken(r, place)) return end(r, GapEnding::taken);
        const bool is_beside = std::abs(front_on_target_m_ - v_.position_m[at(opener)]) <= kRange_m &&
                               (place.leader < 0 || front_on_target_m_ <= v_.position_m[at(place.leader)] + kRange_m);
        if (!is_beside) return end(r, GapEnding::missed);
        const double own_mps = v_.speed_mps[at(opener)];
        if (r.begin_tick < 0 && std::max(own_mps, place.leader_mps) > kCrawlingSpeed_mps) {
            r.begin_tick = state_.tick;
            r.begin_gap_m = place.gap_m;
            r.hold_s = own_mps < kCrawlingSpeed_mps ? std::max(place.missing_m, 0.0) / kDischarge_mps : 0.0;
        }
        if (!r.is_open && place.missing_m <= kReached_m) {
            r.is_open = true;
            ++part_.gap_counts.opened;
            if (r.begin_tick >= 0 && place.leader >= 0)
                part_.gap_counts.given_s +=
                    std::max(place.gap_m - r.begin_gap_m, 0.0) / std::max(place.leader_mps, kDischarge_mps);
        }
        hold_opener(r, place);
        if (!r.is_confirmed || place.leader < 0 || place.leader_mps <= kSlow_mps) return;
        // The requester approaches its place gradually. If it fell behind its place, it might be unable to come
        // forward.
        const double back_mps = std::clamp(-place.spare_m / kApproach_s, -kFallingBack_mps, kFallingBack_mps);
        add_speed_target(state_, part_, lane_, {me.slot, std::max(expected_leader_mps(place) - back_mps, 0.0)});
    }

    // Returns the speed of the leader at the time at which an alignment takes effect. In full dynamics a vehicle
    // reaches its target speed gradually.
    double expected_leader_mps(const Place& place) const {
        if (model_.meso || place.leader < 0) return place.leader_mps;
        return place.leader_mps + v_.acceleration_mps2[at(place.leader)] * SpeedTarget::kTimeToTarget_s;
    }

    // Returns true if another vehicle has changed to the place ahead of the opener. Stores the new leader if the old
    // one has left.
    bool is_taken(GapRequest& r, const Place& place) const {
        const int leader = place.leader < 0 ? -1 : v_.id[at(place.leader)];
        if (leader == r.leader) return false;
        if (leader >= 0 && (r.leader < 0 || slot_on_lane(state_, r.target_lane, r.leader, r.place) >= 0)) return true;
        r.leader = leader;
        return false;
    }

    // The opener drives slower than its leader until the gap suffices, and then holds the gap until the agreement ends.
    void hold_opener(const GapRequest& r, const Place& place) {
        if (r.begin_tick < 0) return;
        const double leader_mps = expected_leader_mps(place);
        double target_mps = leader_mps;
        if (place.missing_m > 0.0)
            target_mps = leader_mps - std::min(kOpening_mps, std::sqrt(2.0 * kOpeningRamp_mps2 * place.missing_m));
        if (model_.time_s(state_.tick - r.begin_tick) < r.hold_s) target_mps = 0.0;
        add_speed_target(state_, part_, r.target_lane, {place.opener, std::max(target_mps, 0.0), kOpeningRamp_mps2});
    }

    // Finds the cheapest opener.
    void search(GapRequest& r, const LaneChangeRequest& me) {
        const LaneBlock& target = state_.blocks[at(r.target_lane)];
        const double left_m = waiting_position_m(model_, state_, me) - me.front_m;
        int best = -1;
        double best_cost_s = 0.0;
        double best_extra_m = 0.0;
        for (int slot = target.first; slot < target.past_last(); ++slot) {
            const double behind_m = front_on_target_m_ - v_.position_m[at(slot)];
            if (behind_m < -kRange_m) continue;
            if (behind_m > kRange_m) break;
            if (!can_open(r.target_lane, slot) || request_tick(r, me, slot) < r.since_tick) continue;
            double extra_m = 0.0;
            const double cost_s = opening_cost_s(r, me, slot, left_m, extra_m);
            if (cost_s < 0.0) continue;
            const bool is_better =
                best < 0 || cost_s < best_cost_s || (cost_s == best_cost_s && v_.id[at(slot)] < v_.id[at(best)]);
            if (!is_better) continue;
            best = slot;
            best_cost_s = cost_s;
            best_extra_m = extra_m;
        }
        if (best < 0) return;
        r.opener = v_.id[at(best)];
        r.leader = best > target.first ? v_.id[at(best - 1)] : -1;
        r.extra_m = best_extra_m;
        r.agreed_tick = state_.tick;
        r.is_confirmed = !uses_channel(model_);
        ++part_.gap_counts.agreed;
    }

    bool can_open(int lane, int slot) const {
        if (!cooperates(slot) || slot == state_.stop_lines.stop_slot[at(lane)] || serves_nearby(lane, slot))
            return false;
        // A vehicle that must leave the lane itself cannot hold a gap open.
        return v_.record[at(slot)].route < 0 || lane_change_request(model_, state_, lane, slot).lane_changes == 0;
    }

    // Returns the sum of the delays of the opener and of the vehicles that follow it closely. Returns -1 if the
    // requester could not take the place, or if the place would be ready too late.
    double opening_cost_s(const GapRequest& r, const LaneChangeRequest& me, int slot, double left_m,
                          double& extra_m) const {
        const LaneBlock& target = state_.blocks[at(r.target_lane)];
        const double speed_mps = v_.speed_mps[at(slot)];
        const double leader_mps = slot > target.first ? v_.speed_mps[at(slot - 1)] : me.speed_mps;
        // A much slower requester cannot reach the place, because the traffic of its own lane holds it up. A faster one
        // comes forward while it brakes to the speed of the leader.
        const double faster_mps = me.speed_mps - leader_mps;
        if (faster_mps < -kFallingBack_mps && me.speed_mps > kCrawlingSpeed_mps) return -1.0;
        if (faster_mps > kFallingBack_mps && leader_mps <= kSlow_mps) return -1.0;
        const bool starts = speed_mps <= kSlow_mps;
        // A vehicle in a standing queue does not agree. Most agreements in standing queues would end unused, because it
        // is unknown when the two queues start. If both discharge and the opener is still stopped, it agrees and delays
        // its start.
        if (me.speed_mps <= kCrawlingSpeed_mps || leader_mps <= kCrawlingSpeed_mps) return -1.0;
        const double forward_m = 0.5 * square(std::max(faster_mps, 0.0)) / SpeedTarget::kDeceleration_mps2;
        const Place place = place_ahead_of(me, r.target_lane, slot, front_on_target_m_ + forward_m);
        const double missing_m = std::max(place.missing_m, 0.0) + place.extra_m;
        if (starts) {
            // The gap may lack at most one vehicle and two standstill gaps, so that the requester is soon beside it.
            const double room_m = me.length_m + 2.0 * v_.standstill_gap_m[at(me.slot)];
            if (missing_m > room_m || place.spare_m < -room_m) return -1.0;
        } else {
            const double opening_s =
                missing_m > 0.0 ? missing_m / kOpening_mps + kOpening_mps / kOpeningRamp_mps2 : 0.0;
            const double back_m = std::max(-place.spare_m, 0.0);
            const double back_s = back_m > 0.0 ? back_m / kFallingBack_mps + kApproach_s : 0.0;
            const double ready_s = std::max(opening_s, back_s);
            if (ready_s > kTimeLimit_s || ready_s * me.speed_mps > left_m) return -1.0;
        }
        extra_m = place.extra_m;
        int followers = 1;
        while (slot + followers < target.past_last() &&
               net_gap_m(v_, slot + followers - 1, slot + followers) <
                   desired_gap_m(model_, v_.policy[at(slot + followers)], speed_mps) + missing_m)
            ++followers;
        return followers * missing_m / std::max(speed_mps, kDischarge_mps);
    }

    // Returns true if the vehicle, or a vehicle near it on its lane, opens a gap.
    bool serves_nearby(int lane, int slot) const {
        const AdjacentLanes& adjacent = state_.plan.adjacent(lane);
        const LaneBlock& block = state_.blocks[at(lane)];
        for (const int beside : {adjacent.left, adjacent.right}) {
            if (beside < 0) continue;
            for (const GapRequest& r : cooperation_.requests[at(beside)]) {
                if (r.target_lane != lane) continue;
                const int other = r.agreed() ? slot_on_lane(state_, lane, r.opener, slot - block.first) : -1;
                if (other >= 0 && std::abs(other - slot) < kFollowersPerOpener) return true;
            }
        }
        return false;
    }

    const Model& model_;
    State& state_;
    const VehicleArrays& v_;
    GapCooperation& cooperation_;
    Partition& part_;
    int lane_;
    const LaneBlock& block_;
    std::vector<GapRequest>& requests_;
    double front_on_target_m_ = 0.0;  // front of the requester, from the start of the target lane
};

}  // namespace

void init_gap_cooperation(const Model& model, State& state) {
    GapCooperation& cooperation = state.gap_cooperation;
    bool is_on = false;
    for (int policy = 0; policy < static_cast<int>(model.policies.size()); ++policy) {
        const DriverPlan& driver = model.driver_of(policy);
        const bool cooperates = !driver.is_human && driver.gap_opening == GapOpening::cooperative;
        cooperation.cooperates.push_back(cooperates ? 1 : 0);
        is_on = is_on || cooperates;
    }
    if (!is_on || state.plan.lanes_with_neighbours().empty()) return;
    cooperation.requests.resize(model.graph.lanes.size());
    cooperation.search_ticks = std::max<std::int64_t>(to_ticks(kSearchInterval_s, model.step_s), 1);
    const V2vPlan& plan = model.v2v_plan;
    cooperation.longest_age_ticks =
        std::max<std::int64_t>(to_ticks(kSilence_s, model.step_s),
                               plan.delay_ticks + plan.longest_jitter_ticks + kLostMessages * plan.interval_ticks);
}

void cooperate_on_gaps(const Model& model, State& state, Partition& part) {
    for (const int lane : part.lanes) {
        if (!state.plan.adjacent(lane).has_neighbours()) continue;
        if (state.blocks[at(lane)].count == 0 && state.gap_cooperation.requests[at(lane)].empty()) continue;
        LaneRequests(model, state, part, lane).run();
    }
}

bool has_gap_agreement(const State& state, int lane, int slot) {
    if (!state.gap_cooperation.is_on()) return false;
    const int id = state.vehicles.id[at(slot)];
    const std::vector<GapRequest>& requests = state.gap_cooperation.requests[at(lane)];
    return std::any_of(requests.begin(), requests.end(),
                       [=](const GapRequest& r) { return r.requester == id && r.is_confirmed; });
}

bool is_reserved(const State& state, int lane, int slot, int requester) {
    if (!state.gap_cooperation.is_on()) return false;
    const int id = state.vehicles.id[at(slot)];
    const AdjacentLanes& adjacent = state.plan.adjacent(lane);
    for (const int beside : {adjacent.left, adjacent.right}) {
        if (beside < 0) continue;
        for (const GapRequest& r : state.gap_cooperation.requests[at(beside)]) {
            if (r.opener == id && r.target_lane == lane) return r.requester != requester;
        }
    }
    return false;
}

}  // namespace stopline
