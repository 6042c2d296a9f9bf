#include "sim/lane_change/preferred_lane.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "base/containers/index.h"

namespace stopline {

namespace {

// Returns the fewest lane changes that a vehicle needs after it has entered `lane`. `turn` is its turn at the end of
// this lane, and `turn_after` is its turn at the next intersection. LaterChanges::at_second: number of lane changes for
// `turn` alone. LaterChanges::in_total: number of lane changes for both turns.
LaterChanges changes_for(const State& state, int lane, Turn turn, Turn turn_after) {
    LaterChanges best{std::abs(state.plan.adjacent(lane).turn_option(turn).lane_changes), kNoTurn};
    const auto rate = [&](int other, int distance) {
        const int route = state.plan.adjacent(other).turn_option(turn).route;
        if (route < 0) return;
        const int exit = state.plan.route(route).back();
        const int after =
            turn_after == Turn::none ? 0 : std::abs(state.plan.adjacent(exit).turn_option(turn_after).lane_changes);
        best.in_total = std::min(best.in_total, distance + after);
    };
    rate(lane, 0);
    int distance = 0;
    for (int other = state.plan.adjacent(lane).right; other >= 0; other = state.plan.adjacent(other).right) {
        rate(other, ++distance);
    }
    distance = 0;
    for (int other = state.plan.adjacent(lane).left; other >= 0; other = state.plan.adjacent(other).left) {
        rate(other, ++distance);
    }
    return best;
}

// Finds the lane from which a vehicle needs the fewest later lane changes; of equally good lanes, the nearest one. The
// current lane is the start value. search() checks the lanes on one side, up to the first lane that does not allow the
// next turn.
class LaneSearch {
public:
    LaneSearch(const Model& model, const State& state, int lane, int slot)
        : model_(model), state_(state), slot_(slot), best_(later_changes(model, state, lane, slot)) {}

    void search(int first, int step, int AdjacentLanes::*side) {
        int offset = 0;
        for (int other = first; other >= 0; other = state_.plan.adjacent(other).*side) {
            const LaterChanges changes = later_changes(model_, state_, other, slot_);
            if (changes.in_total == kNoTurn) return;
            offset += step;
            const bool nearer = changes.in_total == best_.in_total && std::abs(offset) < std::abs(offset_);
            if (changes.in_total > best_.in_total || (changes.in_total == best_.in_total && !nearer)) continue;
            best_ = changes;
            offset_ = offset;
        }
    }

    int offset() const { return offset_; }
    const LaterChanges& best() const { return best_; }

private:
    const Model& model_;
    const State& state_;
    int slot_;
    LaterChanges best_;
    int offset_ = 0;
};

}  // namespace

LaterChanges later_changes(const Model& model, const State& state, int lane, int slot) {
    const VehicleRecord& vehicle = state.vehicles.record[at(slot)];
    const Turn turn = state.plan.turn_of(vehicle.route);
    const int route = state.plan.adjacent(lane).turn_option(turn).route;
    if (route < 0) return {kNoTurn, kNoTurn};
    if (const Itinerary itinerary = state.vehicles.itinerary_of(at(slot)); itinerary.has_trip()) {
        const int changes = state.plan.lane_changes_after(itinerary.trip, itinerary.trip_edge, lane);
        return {changes, changes};
    }
    const int exit = state.plan.route(route).back();
    if (vehicle.following_turn == Turn::none || model.graph.lanes[at(exit)].approach < 0) return {};
    return changes_for(state, exit, vehicle.following_turn, vehicle.third_turn);
}

void update_preferred_lane(const Model& model, State& state, int lane, int slot) {
    if (!state.vehicles.has_lane_changes) return;
    LaneChangeMemory& memory = state.vehicles.lane_memory[at(slot)];
    memory.preferred_offset = 0;
    const AdjacentLanes& adjacent = state.plan.adjacent(lane);
    if (state.vehicles.record[at(slot)].following_turn == Turn::none || !adjacent.has_neighbours()) return;
    const LaterChanges here = later_changes(model, state, lane, slot);
    if (here.in_total == kNoTurn) return;
    LaneSearch search(model, state, lane, slot);
    search.search(adjacent.right, 1, &AdjacentLanes::right);
    search.search(adjacent.left, -1, &AdjacentLanes::left);
    memory.preferred_offset = static_cast<std::int8_t>(search.offset());
    memory.preferred_for_third = search.best().at_second == here.at_second;
}

}  // namespace stopline
