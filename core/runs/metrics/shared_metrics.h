// Metrics that several kinds of networks have.
#pragma once

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <string_view>

#include <fmt/format.h>

#include "base/nan.h"
#include "runs/driving/driving_results.h"
#include "runs/metrics/metric.h"
#include "runs/v2v_results.h"
#include "sim/state/events.h"
#include "sim/state/insertion_state.h"
#include "v2v/fallback.h"

namespace stopline {

// Counters that every run has. Each kind of run returns them from counts().
struct RunCounts {
    std::int64_t entered;
    std::int64_t exited;
    const Violations& violations;
    std::int64_t updates;  // number of vehicles in the network, summed over all steps
    std::uint64_t state_hash;
    const V2vResult& v2v;
    const DepartureDelays& delays;
    std::int64_t backlog;  // vehicles that have arrived but not entered at the end of the run
    const DrivingResults& driving;
};

// Returns the shares of the time in the modes of V2V (v2v/fallback.h). They are in the tables of sweeps.
template <class Run>
MetricList<Run> v2v_metrics() {
    const auto share = [](V2vMode mode) {
        return [mode](const Run& run) { return run.counts().v2v.share_percent(static_cast<std::size_t>(mode)); };
    };
    return {
        {.column = "v2v_old_messages_percent",
         .unit = "%",
         .extent = "run",
         .meaning = "share of the time behind a leader in the mode `old_messages`; empty: no V2V channel is set",
         .value = share(V2vMode::old_messages)},
        {.column = "v2v_radar_percent",
         .unit = "%",
         .extent = "run",
         .meaning = "share of the time behind a leader in the mode `radar`; empty: no V2V channel is set",
         .value = share(V2vMode::radar)},
        {.column = "v2v_acc_percent",
         .unit = "%",
         .extent = "run",
         .meaning = "share of the time behind a leader in the mode `acc`; empty: no V2V channel is set",
         .value = share(V2vMode::acc)},
        {.column = "v2v_platoon_leader_percent",
         .unit = "%",
         .extent = "run",
         .meaning = "share of the time behind a leader in the mode `platoon_leader`; empty: no V2V channel is set, or "
                    "vehicles do not use the messages of their platoon leaders",
         .value = share(V2vMode::platoon_leader)}};
}

// Returns the metrics of vehicles, violations and work. `in_summary` names the metrics in summary.csv. Tables of sweeps
// have all metrics, but their column `overlaps` is the sum of overlaps and conflicts.
template <class Run>
MetricList<Run> count_metrics(std::initializer_list<std::string_view> in_summary) {
    MetricList<Run> metrics{
        {.column = "vehicles_entered",
         .unit = "veh",
         .extent = "run",
         .meaning = "vehicles that entered the network",
         .value = [](const Run& run) { return run.counts().entered; }},
        {.column = "vehicles_exited",
         .unit = "veh",
         .extent = "run",
         .meaning = "vehicles that left the network",
         .value = [](const Run& run) { return run.counts().exited; }},
        {.column = "overlaps",
         .extent = "run",
         .meaning = "vehicles with a net gap below 0, counted in each step; a violation",
         .value = [](const Run& run) { return run.counts().violations.overlaps; },
         .sweep_decimals = kLeftOut},
        {.column = "conflicts",
         .extent = "run",
         .meaning = "pairs of vehicles in one conflict area, counted in each step, except passed blockers; a violation",
         .value = [](const Run& run) { return run.counts().violations.conflicts; },
         .sweep_decimals = kLeftOut},
        {.column = "overlaps",
         .extent = "run",
         .meaning = "sum of `overlaps` and `conflicts` of `network/summary.csv`; a violation",
         .value = [](const Run& run) { return run.counts().violations.overlaps + run.counts().violations.conflicts; },
         .summary_decimals = kLeftOut},
        {.column = "red_entries",
         .unit = "veh",
         .extent = "run",
         .meaning = "vehicles that passed a stop line on red, although they could have stopped; a violation",
         .value = [](const Run& run) { return run.counts().violations.red_entries; }},
        {.column = "forced_red_entries",
         .unit = "veh",
         .extent = "run",
         .meaning = "vehicles that passed a stop line on red because they could not stop any more; no violation",
         .value = [](const Run& run) { return run.counts().violations.forced_red_entries; }},
        {.column = "lost_vehicles",
         .unit = "veh",
         .extent = "run",
         .meaning = "entered vehicles minus exited vehicles and vehicles present at the end; any value but 0 is a "
                    "violation",
         .value = [](const Run& run) { return run.counts().violations.lost_vehicles; }},
        {.column = "deadlocks",
         .extent = "run",
         .meaning = "1 if a vehicle stays in the intersection too long, else 0; a violation. The limit is the slowest "
                    "unobstructed crossing plus two of the longest cycles, or plus 30 s if this is longer. The time "
                    "starts again when the vehicle, or the last vehicle of the chain that it waits for, yields to "
                    "moving traffic",
         .value = [](const Run& run) { return run.counts().violations.deadlocks; }},
        {.column = "updates",
         .extent = "run",
         .meaning = "vehicles times steps",
         .value = [](const Run& run) { return run.counts().updates; },
         .has_mean = false},
        {.column = "state_hash",
         .extent = "end of the run",
         .meaning = "hash of the final state; equal runs give equal hashes",
         .value = [](const Run& run) { return fmt::format("{:016x}", run.counts().state_hash); },
         .has_mean = false},
    };
    for (const Metric<Run>& metric : v2v_metrics<Run>()) metrics.push_back(metric);
    for (Metric<Run>& metric : metrics) {
        const bool is_named = std::find(in_summary.begin(), in_summary.end(), metric.column) != in_summary.end();
        if (!is_named) metric.summary_decimals = kLeftOut;
    }
    return metrics;
}

inline bool asks_for_departure_delay(const Scenario& scenario) { return scenario.measure.departure_delay == "on"; }

// Returns the metrics of the time from the arrival of vehicles to their entry. Only scenarios with
// `measure.departure_delay: on` have them.
template <class Run>
MetricList<Run> departure_metrics() {
    MetricList<Run> metrics{
        {.column = "departure_delay_mean_s",
         .unit = "s",
         .extent = "run",
         .meaning =
             "mean time from the arrival of a vehicle to its entry; vehicles that still wait at the end count "
             "with the time since their arrival; empty: no vehicle has an arrival time, as with saturated "
             "inlets and queues. This column and the next ones are written only with `measure.departure_delay: on`",
         .value = [](const Run& run) { return run.counts().delays.mean_s(); },
         .summary_decimals = 3,
         .console = {.heading = "departure\ndelay",
                     .decimals = 1,
                     .note = "mean time from the arrival of a vehicle to its entry"}},
        {.column = "departure_delay_max_s",
         .unit = "s",
         .extent = "run",
         .meaning = "longest of these times",
         .value = [](const Run& run) { return run.counts().delays.vehicles > 0 ? run.counts().delays.max_s : kNan; },
         .summary_decimals = 3},
        {.column = "arrived_vehicles",
         .unit = "veh",
         .extent = "run",
         .meaning = "vehicles that arrived, with or without room to enter",
         .value = [](const Run& run) { return run.counts().delays.vehicles; }}};
    for (Metric<Run>& metric : metrics) metric.asked_for = asks_for_departure_delay;
    return metrics;
}

// Returns the backlog, for ways of running that report it only with the departure delays.
template <class Run>
Metric<Run> backlog_metric() {
    return {.column = "backlog",
            .unit = "veh",
            .extent = "end of the run",
            .meaning = "vehicles that arrived but found no room to enter",
            .value = [](const Run& run) { return run.counts().backlog; },
            .asked_for = asks_for_departure_delay};
}

// Returns the number of starving movements. `Run` has the member starvations().
template <class Run>
Metric<Run> starvations_metric() {
    return {.column = "starvations",
            .extent = "run",
            .meaning =
                "number of vehicles that are stopped as the first of a queue for `measure.starvation` or longer, and "
                "for two cycles of their signal, although nothing blocks their way; stopline-run fails if "
                "there are any",
            .value = [](const Run& run) { return run.starvations(); }};
}

// Returns the longest stay of a vehicle in an intersection. `Run` has the member longest_in_junction_s().
template <class Run>
Metric<Run> junction_time_metric(int summary_decimals) {
    return {.column = "longest_in_junction_s",
            .unit = "s",
            .extent = "run",
            .meaning =
                "longest time of any vehicle in an intersection, from its front at the stop line to its rear on "
                "the exit lane",
            .value = [](const Run& run) { return run.longest_in_junction_s(); },
            .summary_decimals = summary_decimals,
            .sweep_decimals = 2};
}

}  // namespace stopline
