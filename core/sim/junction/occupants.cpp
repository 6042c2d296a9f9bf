// Lists the vehicles inside intersections. A vehicle enters an intersection when its front passes the stop line, and
// leaves it when its rear reaches the exit lane. A vehicle that will pass the stop line without green is listed before
// it enters, so that crossing vehicles do not start into its path.
#include "sim/junction/occupants.h"

#include <algorithm>

#include "base/containers/index.h"
#include "base/speed_thresholds.h"
#include "sim/junction/arrivals.h"
#include "sim/performance/prefetch.h"

namespace stopline {

namespace {

class OccupantSearch {
public:
    OccupantSearch(const State& state, JunctionState& junctions, Partition& part)
        : state_(state), v_(state.vehicles), junctions_(junctions), part_(part) {}

    // Removes the occupants of the previous step from the occupant lists, and their connections from the bitsets
    // `occupied` and `with_stopped`.
    void clear_lists() {
        for (const int lane : part_.occupants.keys()) {
            const int bit = state_.plan.lane(lane).bitset_index;
            if (bit < 0) continue;
            junctions_.occupied.clear_word_of(at(bit));
            junctions_.with_stopped.clear_word_of(at(bit));
        }
        part_.occupants.clear(junctions_.occupants_place);
    }

    // Adds the vehicles that have their front on an exit lane and their rear still inside the intersection. Checks only
    // the last two vehicles on the exit lane. If the exit lane is shorter than a vehicle, also adds vehicles with their
    // front beyond it. A vehicle past the stop line of the exit lane gets the present tick as its entry time,
    // because its VehicleRecord::junction_entry_tick belongs to the next intersection. Returns false if no vehicle on
    // or beyond the exit lane has its rear upstream of this lane.
    bool add_from_exit(int exit) {
        const bool is_short = state_.plan.lane(exit).length_m < state_.plan.max_space_per_vehicle_m();
        const bool has_beyond = is_short && add_from_beyond(exit);
        const LaneBlock& block = state_.blocks[at(exit)];
        const auto reaches_back = [&](int slot) { return v_.position_m[at(slot)] < v_.length_m[at(slot)]; };
        if (block.count == 0 || !reaches_back(block.last())) return has_beyond;
        for (int slot = std::max(block.first, block.past_last() - 2); slot < block.past_last(); ++slot) {
            if (!reaches_back(slot)) continue;
            const int from = v_.record[at(slot)].previous_lane;
            if (from < 0 || state_.plan.lane(from).exit != exit) continue;
            const bool has_entered_next = v_.position_m[at(slot)] > state_.plan.lane(exit).next_limit_m;
            add(from, slot, state_.plan.lane(from).length_m,
                has_entered_next ? state_.tick : v_.record[at(slot)].junction_entry_tick);
        }
        return true;
    }

    void add_from_connection(int lane) {
        const LaneBlock& block = state_.blocks[at(lane)];
        for (int slot = block.first; slot < block.past_last(); ++slot) add(lane, slot, 0.0);
        if (const int bit = state_.plan.lane(lane).bitset_index; bit >= 0) junctions_.to_decide.set(at(bit));
    }

    // Adds the vehicles on an approach lane that have passed the stop line with their front, or that will pass it
    // although their signal is not green.
    void add_from_approach(int lane) {
        const LaneBlock& block = state_.blocks[at(lane)];
        const LanePlan& plan = state_.plan.lane(lane);
        for (int slot = block.first; slot < block.past_last(); ++slot) {
            const bool is_inside = v_.position_m[at(slot)] > plan.stop_line_m;
            if (!is_inside && !passes_without_green(lane, slot)) break;
            const int next = v_.next_lane[at(slot)];
            if (next < 0 || state_.plan.lane(next).origin != lane) continue;
            add(next, slot, -plan.length_m, is_inside ? v_.record[at(slot)].junction_entry_tick : state_.tick);
        }
    }

    void update_bitsets() {
        for (const int lane : part_.occupants.keys()) {
            const std::span<const JunctionOccupant> occupants_of_lane = occupants_of(state_, lane);
            part_.longest_in_junction_ticks =
                std::max(part_.longest_in_junction_ticks, state_.tick - occupants_of_lane.front().since_tick);
            const int bit = state_.plan.lane(lane).bitset_index;
            if (bit < 0) continue;
            junctions_.occupied.set(at(bit));
            const auto is_slow = [&](const JunctionOccupant& occupant) {
                return v_.speed_mps[at(occupant.slot)] < kCrawlingSpeed_mps;
            };
            if (std::any_of(occupants_of_lane.begin(), occupants_of_lane.end(), is_slow))
                junctions_.with_stopped.set(at(bit));
        }
        for (const int lane : part_.occupants.keys()) {
            if (state_.plan.lane(lane).yields || junctions_.occupied.has_any(state_.plan.conflicting(lane)))
                state_.plan.prefetch_conflicts(lane);
        }
    }

private:
    // Adds the vehicles that have their front beyond the exit lane, on a connection of the next intersection, and their
    // rear still upstream of the exit lane. Returns true if there are any.
    bool add_from_beyond(int exit) {
        const double exit_m = state_.plan.lane(exit).length_m;
        bool found = false;
        for (const int next : state_.plan.next(exit)) {
            const LaneBlock& block = state_.blocks[at(next)];
            for (int slot = block.first; slot < block.past_last(); ++slot) {
                if (exit_m + v_.position_m[at(slot)] >= v_.length_m[at(slot)]) continue;
                const int from = v_.record[at(slot)].second_previous_lane;
                if (v_.record[at(slot)].previous_lane != exit || from < 0 || state_.plan.lane(from).exit != exit)
                    continue;
                add(from, slot, state_.plan.lane(from).length_m + exit_m, state_.tick);
                found = true;
            }
        }
        return found;
    }

    // Returns true if the vehicle will pass the line although the signal of its movement is not green. The caller asks
    // only for vehicles up to the one that was chosen to stop (StopLineState::stopping_vehicle). All vehicles ahead of
    // the chosen one pass the line, because they are too near to stop. In the step in which the light changes, no
    // vehicle has been chosen yet, so the result is false.
    bool passes_without_green(int lane, int slot) const {
        if (state_.stop_lines.lines[at(lane)].stopping_vehicle == v_.id[at(slot)]) return false;
        const int group = state_.plan.signal_group_for(lane, v_.next_lane[at(slot)]);
        return state_.signals.lights[at(group)] != Light::green && state_.signals.since_tick[at(group)] < state_.tick;
    }

    void add(int lane, int slot, double offset_m) {
        add(lane, slot, offset_m, v_.record[at(slot)].junction_entry_tick);
    }
    void add(int lane, int slot, double offset_m, std::int64_t since_tick) {
        const double front_m = v_.position_m[at(slot)] + offset_m;
        part_.occupants.add(lane, {slot, front_m, front_m - v_.length_m[at(slot)], since_tick},
                            junctions_.occupants_place);
    }

    const State& state_;
    const VehicleArrays& v_;
    JunctionState& junctions_;
    Partition& part_;
};

}  // namespace

void find_junction_occupants(const State& state, JunctionState& junctions, Partition& part) {
    OccupantSearch search(state, junctions, part);
    search.clear_lists();
    // Each list must begin with the vehicle furthest downstream. Exit lanes are therefore searched first, then
    // connections, then approach lanes.
    part.exit_candidates.retain_if([&](std::size_t place) {
        advance_prefetch(state, part.prefetch);
        return search.add_from_exit(part.exits[place]);
    });
    for (const int lane : part.awake_connections) search.add_from_connection(lane);
    for (const int lane : part.awake_approaches) search.add_from_approach(lane);
    search.update_bitsets();
}

}  // namespace stopline
