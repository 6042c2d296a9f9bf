#include "sim/junction/deadlock_avoidance.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include "base/containers/index.h"
#include "base/speed_thresholds.h"
#include "sim/junction/arrivals.h"
#include "sim/perception/look_ahead.h"
#include "sim/state/queries/stopping_distance.h"
#include "sim/state/queries/vehicle_place.h"

namespace stopline {

namespace {

// A vehicle in the intersection, or on an approach lane of the intersection.
struct OnConnection {
    int connection = -1;   // connection that the vehicle is on or takes next; -1: none in this intersection
    double front_m = 0.0;  // front position, from the start of the connection
};

// A vehicle of a chain in which each vehicle is blocked by the next one. The vehicle blocks the previous one of the
// chain if it stops with its front between two positions.
struct ChainLink {
    int slot = -1;
    double from_m = -kNoWait_m;  // from the start of the vehicle's connection
    double to_m = kNoWait_m;

    bool blocks_from(double front_m) const { return front_m > from_m && front_m < to_m; }
    bool operator==(const ChainLink&) const = default;
};

class CycleSearch {
public:
    CycleSearch(const Model& model, const State& state, int lane, const Candidate& candidate)
        : model_(model),
          state_(state),
          v_(state.vehicles),
          conflicts_(state.plan.conflicts(lane)),
          candidate_(candidate),
          margin_m_(margin_m(candidate.slot)),
          length_m_(state.vehicles.length_m[at(candidate.slot)]),
          intersection_(state.plan.intersection_of(lane)) {
        for (const Conflict& conflict : conflicts_) {
            if (conflict.from_m < candidate.front_m) continue;
            for_each_holder(conflict, [&](const ChainLink& link) { check_stop(conflict.from_m - margin_m_, link); });
        }
        int leader = -1;
        for (const JunctionOccupant& occupant : occupants_of(state_, lane)) {
            if (occupant.rear_m < candidate.front_m) continue;
            leader = occupant.slot;
            if (is_crawling(leader)) check_stop(occupant.rear_m - standstill_gap_m(candidate.slot), {leader});
        }
        if (leader >= 0 && !is_crawling(leader)) check_stop_behind(leader);
    }

    const KeptOutArea& result() const { return result_; }

private:
    bool is_crawling(int slot) const { return v_.speed_mps[at(slot)] < kCrawlingSpeed_mps; }
    double margin_m(int slot) const { return model_.driver_of(v_.policy[at(slot)]).give_way.margin_m; }
    double standstill_gap_m(int slot) const { return v_.standstill_gap_m[at(slot)]; }
    double length_m(int slot) const { return v_.length_m[at(slot)]; }

    // Returns true if the vehicle waits before the conflict area that starts at `area_m`, or can still stop there.
    bool can_wait_before(int slot, double front_m, double area_m) const {
        return front_m <= area_m && (brakes_for(slot, area_m) || can_stop(slot, area_m - front_m));
    }

    // Returns true if the vehicle already brakes for the area, or for a position further upstream. Such a vehicle can
    // wait before the area, although its stop can deviate slightly from the planned one.
    bool brakes_for(int slot, double area_m) const {
        return had_to_wait(state_, slot) && v_.record[at(slot)].yield_position_m <= static_cast<float>(area_m);
    }

    // Returns true if the vehicle can stop before a conflict area at this distance. Only a crawling vehicle may use the
    // margin before the area. In the mesoscale mode, braking starts at once.
    bool can_stop(int slot, double distance_m) const {
        const double room_m = distance_m - (is_crawling(slot) ? 0.0 : margin_m(slot));
        if (model_.meso) return can_stop_within(model_, v_.speed_mps[at(slot)], room_m);
        const DriverPlan& driver = model_.driver_of(v_.policy[at(slot)]);
        return can_stop_after_response(model_, v_, slot, room_m, driver.tables.cacc.deceleration_emergency_mps2);
    }

    // Calls `visit` with a ChainLink for each vehicle of connection `conflict.other` that can block the conflict area:
    //   - A crawling vehicle in the area. It blocks the area wherever it stops next.
    //   - Another vehicle that is in the area or can no longer stop before it. It blocks the area if it stops there.
    template <class Visit>
    void for_each_holder(const Conflict& conflict, const Visit& visit) const {
        for (const JunctionOccupant& occupant : occupants_of(state_, conflict.other)) {
            const int slot = occupant.slot;
            if (occupant.rear_m >= conflict.other_to_m || slot == candidate_.slot) continue;
            if (occupant.front_m > conflict.other_from_m && is_crawling(slot)) {
                visit(ChainLink{slot});
            } else if (must_enter(slot, occupant.front_m, conflict.other_from_m)) {
                visit(ChainLink{slot, conflict.other_from_m, conflict.other_to_m + length_m(slot)});
            }
        }
        for_each_approaching_holder(conflict, visit);
    }

    // Does the same as for_each_holder() for the vehicles upstream of the stop line.
    template <class Visit>
    void for_each_approaching_holder(const Conflict& conflict, const Visit& visit) const {
        const int origin = state_.plan.lane(conflict.other).origin;
        const LanePlan& lane = state_.plan.lane(origin);
        const LaneBlock& block = state_.blocks[at(origin)];
        for (int slot = block.first; slot < block.past_last(); ++slot) {
            if (slot == state_.stop_lines.stop_slot[at(origin)]) return;
            if (v_.position_m[at(slot)] > lane.stop_line_m) continue;
            if (!must_enter(slot, v_.position_m[at(slot)] - lane.length_m, conflict.other_from_m)) return;
            if (v_.next_lane[at(slot)] != conflict.other || slot == candidate_.slot) continue;
            visit(ChainLink{slot, conflict.other_from_m, conflict.other_to_m + length_m(slot)});
        }
    }

    // Returns true if the vehicle is past the start of the area or can no longer stop before it. If the candidate and
    // another vehicle can stop for the last time in the same step, only one of them must see the other one as unable to
    // stop: the candidate with the higher id reduces the distance of the other one by a reserve of kBrakeResponse_s and
    // two steps.
    bool must_enter(int slot, double front_m, double area_m) const {
        if (!can_wait_before(slot, front_m, area_m)) return true;
        if (v_.id[at(slot)] > v_.id[at(candidate_.slot)] || brakes_for(slot, area_m)) return false;
        const double acceleration_mps2 = std::max(static_cast<double>(v_.acceleration_mps2[at(slot)]), 0.0);
        const double soon_mps = v_.speed_mps[at(slot)] + kBrakeResponse_s * acceleration_mps2;
        return !can_stop(slot, area_m - front_m - (kBrakeResponse_s + 2.0 * model_.step_s) * soon_mps);
    }

    // Checks the areas that the candidate would block if it stopped at `place_m` because of `blocker`.
    void check_stop(double place_m, const ChainLink& blocker) {
        for (const Conflict& area : conflicts_) {
            if (area.from_m >= std::min(place_m, result_.from_m)) return;
            if (area.to_m > place_m - length_m_ && closes_cycle(area, blocker)) return;
        }
    }

    // Checks the areas that the candidate would block if it stopped behind its leader, which is still driving.
    void check_stop_behind(int leader) {
        const double behind_m = length_m(leader) + standstill_gap_m(candidate_.slot);
        for (const Conflict& area : conflicts_) {
            if (area.from_m >= result_.from_m) return;
            if (closes_cycle(area, {leader, area.from_m + behind_m, area.to_m + length_m_ + behind_m})) return;
        }
    }

    // Returns true if the candidate can stop before `area` and must do so: it would block the area, and `blocker` leads
    // to a vehicle that must cross the area. The stop before the area can close a cycle as well, so the function then
    // checks it.
    bool closes_cycle(const Conflict& area, const ChainLink& blocker) {
        if (!can_wait_before(candidate_.slot, candidate_.front_m, area.from_m)) return false;
        const int crossing_slot = find_crossing(area, blocker);
        if (crossing_slot < 0) return false;
        result_ = {area.from_m, crossing_slot};
        check_stop(area.from_m - margin_m_, {crossing_slot});
        return true;
    }

    // Returns the slot of a vehicle that must still cross the area and that is in the path of the vehicle in `start`,
    // directly or through further vehicles; -1: none.
    int find_crossing(const Conflict& area, const ChainLink& start) const {
        constexpr std::size_t kMaxLinks = 24;
        std::array<ChainLink, kMaxLinks> found = {start};
        std::size_t count = 1;
        int crossing_slot = -1;
        const auto visit = [&](const ChainLink& link) {
            const OnConnection on = on_connection(link.slot);
            if (on.connection == area.other && waits_before(link, on, area.other_from_m)) crossing_slot = link.slot;
            const auto end = found.begin() + static_cast<std::ptrdiff_t>(count);
            if (count < kMaxLinks && std::find(found.begin(), end, link) == end) found[count++] = link;
        };
        for (std::size_t k = 0; k < count && crossing_slot < 0; ++k) visit_path(found[k], visit);
        return crossing_slot;
    }

    // Returns true if a vehicle of the chain can still stop before the area that starts at `area_m`, and blocks the
    // previous vehicle of the chain from there.
    bool waits_before(const ChainLink& link, const OnConnection& on, double area_m) const {
        if (!can_wait_before(link.slot, on.front_m, area_m)) return false;
        return link.blocks_from(std::max(on.front_m, area_m - margin_m(link.slot)));
    }

    // Calls `visit` with the next links of the chain after `link`: the vehicles that block the conflict areas before
    // which the vehicle can wait, and its leader.
    template <class Visit>
    void visit_path(const ChainLink& link, const Visit& visit) const {
        const OnConnection on = on_connection(link.slot);
        if (on.connection < 0) return;
        for (const Conflict& conflict : state_.plan.conflicts(on.connection)) {
            if (conflict.from_m >= on.front_m && waits_before(link, on, conflict.from_m))
                for_each_holder(conflict, visit);
        }
        if (is_crawling(link.slot)) {
            if (const int leader = queue_leader(link.slot); leader >= 0) visit(ChainLink{leader});
        } else {
            visit_leader(link, on, visit);
        }
    }

    // Returns the slot of the crawling leader of a queued vehicle; -1: none.
    int queue_leader(int slot) const {
        if (!is_blocked_by_leader(state_, slot)) return -1;
        const int lane = lane_of(state_, slot);
        if (slot != state_.blocks[at(lane)].first) return slot - 1;
        return leader_ahead(state_, lane, slot, queue_look_ahead_m(state_, slot)).slot;
    }

    // Calls `visit` with the leader on the same connection, if there is one. `link`: a vehicle that does not crawl.
    template <class Visit>
    void visit_leader(const ChainLink& link, const OnConnection& on, const Visit& visit) const {
        int leader = -1;
        for (const JunctionOccupant& occupant : occupants_of(state_, on.connection)) {
            if (occupant.rear_m < on.front_m) break;
            leader = occupant.slot;
        }
        if (leader < 0 || leader == candidate_.slot) return;
        const double behind_m = length_m(leader) + standstill_gap_m(link.slot);
        visit(ChainLink{leader, link.from_m + behind_m, link.to_m + behind_m});
    }

    OnConnection on_connection(int slot) const {
        const int lane = lane_of(state_, slot);
        if (state_.plan.intersection_of(lane) != intersection_) return {};
        if (state_.plan.lane(lane).origin >= 0) return {lane, v_.position_m[at(slot)]};
        const int next = v_.next_lane[at(slot)];
        if (next < 0 || state_.plan.lane(next).origin != lane) return {};
        return {next, v_.position_m[at(slot)] - state_.plan.lane(lane).length_m};
    }

    const Model& model_;
    const State& state_;
    const VehicleArrays& v_;
    std::span<const Conflict> conflicts_;  // those of the candidate's connection
    const Candidate& candidate_;
    double margin_m_;
    double length_m_;
    int intersection_;
    KeptOutArea result_;
};

}  // namespace

KeptOutArea area_to_keep_clear(const Model& model, const State& state, int lane, const Candidate& candidate) {
    if (!model.rules.keep_clear || model.rules.pass_blocker_ticks > 0) return {};
    // A cycle that contains the candidate also contains a vehicle on a conflicting connection.
    if (!state.junctions.occupied.has_any(state.plan.conflicting(lane))) return {};
    return CycleSearch(model, state, lane, candidate).result();
}

}  // namespace stopline
