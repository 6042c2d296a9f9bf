// What holds after every step of every run: nobody overlaps its predecessor (on another lane: look_beyond.cpp), nobody is lost.
#include <algorithm>

#include "sim/phases.h"

namespace stopline {

std::int64_t overlaps(const VehicleArrays& v, std::span<const LaneStep> lanes) {
    constexpr double kRounding_m = 1e-6;
    const double* const position = v.position_m.data();
    const float* const length = v.length_m.data();
    std::int64_t count = 0;
    for (const LaneStep& lane : lanes) {
        for (int i = lane.begin + 1; i < lane.stop; ++i) {
            const double gap_m = position[i - 1] - static_cast<double>(length[i - 1]) - position[i];
            count += gap_m < -kRounding_m ? 1 : 0;
        }
    }
    return count;
}

// Of those that overlap, as they are now.
void see_overlap(const Model& model, const State& state, NetworkPart& part) {
    const VehicleArrays& v = state.vehicles;
    for (const int lane : part.occupied) {
        const LaneBlock& block = state.blocks[static_cast<std::size_t>(lane)];
        for (int slot = block.first; slot < block.stop(); ++slot) {
            const auto i = static_cast<std::size_t>(slot);
            if (v.position_m[i] <= v.position_m[i - 1] - static_cast<double>(v.length_m[i - 1])) continue;
            const int ahead = slot > block.first ? v.id[i - 1] : v.record[i].predecessor;
            part.violations.see({model.time_s(state.tick + 1), Sighting::Kind::overlap, lane, v.id[i], ahead});
        }
    }
}

void verify(State& state) {
    std::int64_t present = state.limbo.count;
    for (const LaneBlock& block : state.blocks) present += block.count;
    state.violations.lost_vehicles = state.entered - state.left - present;
}

void gather_reports(State& state) {
    const auto take = [](auto& all, auto& part) {
        all.insert(all.end(), part.begin(), part.end());
        part.clear();
    };
    std::vector<RuleUse> rules;
    std::int64_t present = state.limbo.count;
    for (NetworkPart& part : state.parts) {
        present += part.present;
        state.updates += part.updates;
        state.longest_inside = std::max(state.longest_inside, part.longest_inside);
        state.hindrance.passed_blockers += part.passed_blockers;
        state.violations.add(part.violations);
        part.updates = part.longest_inside = part.passed_blockers = 0;
        part.violations = {};
        take(state.crossings, part.crossings);
        take(state.gaps_accepted, part.gaps_accepted);
        take(rules, part.rules);
    }
    std::stable_sort(rules.begin(), rules.end(),
                     [](const RuleUse& a, const RuleUse& b) { return a.vehicle < b.vehicle; });
    take(state.hindrance.rules, rules);
    // As many as there were at the beginning of the step; nobody has come or gone since.
    state.violations.lost_vehicles = state.entered - state.left - present;
}

}  // namespace stopline
