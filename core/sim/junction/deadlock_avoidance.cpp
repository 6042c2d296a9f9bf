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

namespace stopline {

namespace {

// A vehicle in the intersection, or on an approach lane of the intersection.
struct OnConnection {
    int connection = -1;   // connection that the vehicle is on or takes next; -1: none in this intersection
    double front_m = 0.0;  // front position, from the start of the connection
};

class CycleSearch {
public:
    CycleSearch(const Model& model, const State& state, int lane, const Candidate& v)
        : model_(model),
          state_(state),
          arrays_(state.vehicles),
          conflicts_(state.plan.conflicts(lane)),
          v_(v),
          margin_m_(model.driver_of(state.vehicles.policy[at(v.slot)]).give_way.margin_m),
          length_m_(state.vehicles.length_m[at(v.slot)]),
          intersection_(state.plan.intersection_of(lane)) {
        for (const Conflict& conflict : conflicts_) {
            if (conflict.from_m < v.front_m) continue;
            for_each_in_area(conflict, [&](const JunctionOccupant& occupant) {
                check_stop(conflict.from_m - margin_m_, occupant.slot);
            });
        }
        for (const JunctionOccupant& occupant : state.junctions.occupants[at(lane)]) {
            if (occupant.rear_m < v.front_m || !is_crawling(occupant.slot)) continue;
            check_stop(occupant.rear_m - arrays_.standstill_gap_m[at(v.slot)], occupant.slot);
        }
    }

    const KeptOutArea& result() const { return result_; }

private:
    bool is_crawling(int slot) const { return arrays_.speed_mps[at(slot)] < kCrawlingSpeed_mps; }

    // Calls `visit` for each crawling vehicle of connection `conflict.other` that is in the conflict area.
    template <class Visit>
    void for_each_in_area(const Conflict& conflict, const Visit& visit) const {
        for (const JunctionOccupant& occupant : state_.junctions.occupants[at(conflict.other)]) {
            const bool is_in_area = occupant.front_m > conflict.other_from_m && occupant.rear_m < conflict.other_to_m;
            if (is_in_area && is_crawling(occupant.slot)) visit(occupant);
        }
    }

    // Checks the areas that the candidate would block if it stopped at `place_m`. `blocker`: slot of the vehicle that
    // the candidate would wait for. If the candidate must not enter one of these areas, it stops before that area. This
    // stop can close a cycle as well, so the function then checks it.
    void check_stop(double place_m, int blocker) {
        for (const Conflict& area : conflicts_) {
            if (area.from_m >= std::min(place_m, result_.from_m)) return;
            const double stop_m = area.from_m - margin_m_;
            if (area.from_m < v_.front_m || area.to_m <= place_m - length_m_) continue;
            if (!v_.stopped && !can_stop_within(model_, arrays_.speed_mps[at(v_.slot)], stop_m - v_.front_m)) continue;
            const int crossing_slot = find_crossing(area, blocker);
            if (crossing_slot < 0) continue;
            result_ = {area.from_m, crossing_slot};
            check_stop(stop_m, crossing_slot);
            return;
        }
    }

    // Returns the slot of a crawling vehicle that must still cross the area and that is in the path of the vehicle in
    // `start`, directly or through further crawling vehicles; -1: none.
    int find_crossing(const Conflict& area, int start) const {
        constexpr std::size_t kMaxVehicles = 16;
        std::array<int, kMaxVehicles> found = {start};
        std::size_t count = 1;
        int crossing_slot = -1;
        const auto visit = [&](int slot) {
            if (const OnConnection on = on_connection(slot);
                on.connection == area.other && on.front_m <= area.other_from_m) {
                crossing_slot = slot;
            }
            const auto end = found.begin() + static_cast<std::ptrdiff_t>(count);
            if (count < kMaxVehicles && std::find(found.begin(), end, slot) == end) found[count++] = slot;
        };
        for (std::size_t k = 0; k < count && crossing_slot < 0; ++k) visit_path(found[k], visit);
        return crossing_slot;
    }

    // Calls `visit` with the slot of each crawling vehicle in the path of the vehicle in `slot`: the vehicles in the
    // conflict areas ahead, and the leader of a queued vehicle.
    template <class Visit>
    void visit_path(int slot, const Visit& visit) const {
        const OnConnection on = on_connection(slot);
        if (on.connection < 0) return;
        for (const Conflict& conflict : state_.plan.conflicts(on.connection)) {
            if (conflict.from_m < on.front_m) continue;
            for_each_in_area(conflict, [&](const JunctionOccupant& occupant) { visit(occupant.slot); });
        }
        if (!is_blocked_by_leader(state_, slot)) return;
        const int lane = lane_of(slot);
        const bool is_first = slot == state_.blocks[at(lane)].first;
        const int leader =
            is_first ? leader_ahead(state_, lane, slot, queue_look_ahead_m(state_, slot)).slot : slot - 1;
        if (leader >= 0) visit(leader);
    }

    int lane_of(int slot) const {
        const VehicleRecord& record = arrays_.record[at(slot)];
        return state_.plan.route(record.route)[at(record.route_index)];
    }

    OnConnection on_connection(int slot) const {
        const int lane = lane_of(slot);
        if (state_.plan.intersection_of(lane) != intersection_) return {};
        if (state_.plan.lane(lane).origin >= 0) return {lane, arrays_.position_m[at(slot)]};
        const int next = arrays_.next_lane[at(slot)];
        if (next < 0 || state_.plan.lane(next).origin != lane) return {};
        return {next, arrays_.position_m[at(slot)] - state_.plan.lane(lane).length_m};
    }

    const Model& model_;
    const State& state_;
    const VehicleArrays& arrays_;
    std::span<const Conflict> conflicts_;  // those of the candidate's connection
    const Candidate& v_;
    double margin_m_;
    double length_m_;
    int intersection_;
    KeptOutArea result_;
};

}  // namespace

KeptOutArea area_to_keep_clear(const Model& model, const State& state, int lane, const Candidate& v) {
    if (!model.rules.keep_clear || model.rules.pass_blocker_ticks > 0) return {};
    // A cycle that contains the candidate also contains a crawling vehicle on a conflicting connection.
    if (!state.junctions.with_stopped.has_any(state.plan.conflicting(lane))) return {};
    return CycleSearch(model, state, lane, v).result();
}

}  // namespace stopline
