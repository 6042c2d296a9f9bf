// Counts conflicts: pairs of vehicles from different connections in the same conflict area. The decisions in
// right_of_way.cpp should prevent all conflicts.
#include "sim/junction/count_conflicts.h"

#include <algorithm>
#include <utility>

#include "base/containers/index.h"
#include "sim/junction/merging.h"
#include "sim/state/delay_log.h"
#include "sim/state/events.h"

namespace stopline {

namespace {

// Returns true if the pass-blocker rule (driver/traffic_rules.h) lets one of two vehicles in the same conflict area
// pass the other vehicle. Records the use of the rule in the first step in which both vehicles are in the area.
bool pass_is_allowed(const Model& model, const State& state, Partition& part, int slot_a, int lane_a, int slot_b,
                     int lane_b) {
    const std::pair<int, int> pair = std::minmax(state.vehicles.id[at(slot_a)], state.vehicles.id[at(slot_b)]);
    for (BlockerPass& known : part.blocker_passes) {
        if (std::pair<int, int>(std::minmax(known.vehicle, known.blocker)) != pair) continue;
        known.last_needed_tick = state.tick;
        if (known.begun) return true;
        known.begun = true;
        ++part.passed_blockers;
        part.rule_uses.push_back({RuleUse::Kind::passed_blocker, model.time_s(state.tick), known.vehicle,
                                  known.vehicle == state.vehicles.id[at(slot_a)] ? lane_a : lane_b, known.blocker,
                                  model.time_s(known.blocker_stopped_ticks)});
        return true;
    }
    return false;
}

// Returns true if one of two vehicles that merge into one exit lane is wholly ahead of the other.
bool are_in_line(const State& state, int lane, const JunctionOccupant& own, int other_lane,
                 const JunctionOccupant& other) {
    const double own_end_m = state.plan.lane(lane).length_m;
    const double other_end_m = state.plan.lane(other_lane).length_m;
    return own_end_m - own.front_m >= other_end_m - other.rear_m ||
           other_end_m - other.front_m >= own_end_m - own.rear_m;
}

// Returns the number of vehicle pairs in conflict area `c` of connection `lane`, and records each pair as a violation.
// Leaves out pairs that the pass-blocker rule allows, and merging vehicles of which one is wholly ahead of the other.
std::int64_t count_pairs(const Model& model, const State& state, Partition& part, int lane, const Conflict& c) {
    std::int64_t pairs = 0;
    for (const JunctionOccupant& own : occupants_of(state, lane)) {
        if (own.front_m <= c.from_m || own.rear_m >= c.to_m) continue;
        for (const JunctionOccupant& other_vehicle : occupants_of(state, c.other)) {
            if (other_vehicle.front_m <= c.other_from_m || other_vehicle.rear_m >= c.other_to_m) continue;
            if (is_merge(model, state, lane, c) && are_in_line(state, lane, own, c.other, other_vehicle)) continue;
            if (pass_is_allowed(model, state, part, own.slot, lane, other_vehicle.slot, c.other)) continue;
            const auto& id = state.vehicles.id;
            part.violations.record({model.time_s(state.tick), Violation::Kind::conflict, lane, id[at(own.slot)],
                                    id[at(other_vehicle.slot)]});
            ++pairs;
        }
    }
    return pairs;
}

// Returns the number of conflicts between connection `lane` and connections whose lane index is higher than `lane`. The
// calls for the connections with lower indices count the other conflicts of `lane`, so each pair is counted once.
std::int64_t count_conflicts_of_lane(const Model& model, const State& state, Partition& part, int lane) {
    std::int64_t pairs = 0;
    for (const Conflict& c : state.plan.conflicts(lane)) {
        if (c.other > lane && !occupants_of(state, c.other).empty()) pairs += count_pairs(model, state, part, lane, c);
    }
    return pairs;
}

}  // namespace

void count_conflicts(const Model& model, const State& state, Partition& part) {
    for (const int lane : part.occupants.keys()) {
        if (state.junctions.occupied.has_any(state.plan.conflicting(lane)))
            part.violations.conflicts += count_conflicts_of_lane(model, state, part, lane);
    }
}

}  // namespace stopline
