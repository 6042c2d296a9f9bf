#include "sim/step/partition_reports.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "sim/state/delay_log.h"

namespace stopline {

namespace {

// Sets the number of lost vehicles: vehicles that entered, minus those that exited, minus those present.
void update_lost_vehicles(RunRecords& records, std::int64_t present) {
    records.violations.lost_vehicles = records.entered - records.exited - present;
}

}  // namespace

void count_lost_vehicles(State& state) {
    std::int64_t present = state.congestion.teleporting.count;
    for (const LaneBlock& block : state.blocks) present += block.count;
    update_lost_vehicles(state.records, present);
}

void merge_partition_reports(State& state) {
    const auto move_to = [](auto& target, auto& source) {
        target.insert(target.end(), source.begin(), source.end());
        source.clear();
    };
    RunRecords& records = state.records;
    std::vector<RuleUse> rule_uses;
    std::vector<V2vModeChange> v2v_mode_changes;
    std::int64_t present = state.congestion.teleporting.count;
    for (Partition& part : state.partitions) {
        present += part.present;
        records.updates += part.updates;
        records.longest_in_junction_ticks = std::max(records.longest_in_junction_ticks, part.longest_in_junction_ticks);
        state.congestion.delays.passed_blockers += part.passed_blockers;
        state.congestion.delays.refused += part.refused;
        state.congestion.delays.refusal_ticks += part.refusal_ticks;
        state.congestion.delays.stops += part.stops;
        state.congestion.delays.advised_ticks += part.advised;
        records.violations.add(part.violations);
        part.updates = part.longest_in_junction_ticks = part.passed_blockers = part.refused = part.refusal_ticks = 0;
        part.stops = part.advised = 0;
        part.violations = {};
        records.gap_counts.add(part.gap_counts);
        part.gap_counts = {};
        move_to(records.crossings, part.crossings);
        move_to(records.gaps_accepted, part.gaps_accepted);
        move_to(rule_uses, part.rule_uses);
        move_to(v2v_mode_changes, part.v2v_mode_changes);
        for (std::size_t mode = 0; mode < kV2vModes; ++mode) {
            records.v2v_mode_steps[mode] += part.v2v_mode_steps[mode];
        }
        part.v2v_mode_steps = {};
    }
    std::stable_sort(rule_uses.begin(), rule_uses.end(),
                     [](const RuleUse& a, const RuleUse& b) { return a.vehicle < b.vehicle; });
    move_to(state.congestion.delays.rule_uses, rule_uses);
    std::stable_sort(v2v_mode_changes.begin(), v2v_mode_changes.end(),
                     [](const V2vModeChange& a, const V2vModeChange& b) { return a.vehicle < b.vehicle; });
    move_to(records.v2v_mode_changes, v2v_mode_changes);
    // Each partition counts its vehicles at the start of the step. The sum is still correct here, because vehicles
    // enter and leave the network only in later phases of the step.
    update_lost_vehicles(records, present);
}

}  // namespace stopline
