// Vehicles of different lanes that are in the same conflict area: what giving way (right_of_way.cpp) is there to prevent.
#include <algorithm>
#include <utility>

#include "sim/phases.h"

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

// Whether one of two vehicles in the same area passes the other by the rule for blockers; notes when it begins to.
bool passes(const Model& model, State& state, NetworkPart& part, int one, int lane, int two, int other) {
    const std::pair<int, int> pair = std::minmax(state.vehicles.id[at(one)], state.vehicles.id[at(two)]);
    for (Passing& known : part.passing) {
        if (std::pair<int, int>(std::minmax(known.vehicle, known.blocker)) != pair) continue;
        known.seen = state.tick;
        if (known.begun) return true;
        known.begun = true;
        ++part.passed_blockers;
        part.rules.push_back({RuleUse::Kind::passed_blocker, model.time_s(state.tick), known.vehicle,
                              known.vehicle == state.vehicles.id[at(one)] ? lane : other, known.blocker,
                              model.time_s(known.stood)});
        return true;
    }
    return false;
}

// Pairs of vehicles that are in the area at the same time, but for those that pass each other by a rule.
std::int64_t pairs_in(const Model& model, State& state, NetworkPart& part, int lane, const Conflict& c) {
    std::int64_t pairs = 0;
    for (const Insider& w : state.insiders[at(lane)]) {
        if (w.front_m <= c.from_m || w.rear_m >= c.to_m) continue;
        for (const Insider& x : state.insiders[at(c.other)]) {
            if (x.front_m <= c.other_from_m || x.rear_m >= c.other_to_m) continue;
            if (passes(model, state, part, w.slot, lane, x.slot, c.other)) continue;
            const auto& id = state.vehicles.id;
            part.violations.see(
                {model.time_s(state.tick), Sighting::Kind::conflict, lane, id[at(w.slot)], id[at(x.slot)]});
            ++pairs;
        }
    }
    return pairs;
}

// The same, of a lane with all others.
std::int64_t conflicts_of(const Model& model, State& state, NetworkPart& part, int lane) {
    std::int64_t pairs = 0;
    for (const Conflict& c : state.plan.conflicts(lane)) {
        if (c.other > lane && !state.insiders[at(c.other)].empty()) pairs += pairs_in(model, state, part, lane, c);
    }
    return pairs;
}

}  // namespace

void count_conflicts(const Model& model, State& state, NetworkPart& part) {
    for (const int lane : part.with_insiders) {
        if (state.with_insiders.has_any(state.plan.meets(lane)))
            part.violations.conflicts += conflicts_of(model, state, part, lane);
    }
}

}  // namespace stopline
