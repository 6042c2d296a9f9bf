// The metrics of comfort and surrogate safety. Only scenarios with `measure.surrogate_safety: on` have them.
#pragma once

#include "runs/metrics/shared_metrics.h"

namespace stopline {

inline bool asks_for_safety(const Scenario& scenario) { return scenario.measure.surrogate_safety == "on"; }

template <class Run>
MetricList<Run> comfort_metrics() {
    const auto jerk = [](const Run& run) -> const SafetyDistribution& {
        return run.counts().driving.safety.of(SafetyMeasure::jerk);
    };
    return {
        {.column = "jerk_p1_mps3",
         .unit = "m/s3",
         .extent = "run",
         .meaning =
             "first percentile of the jerk of moving vehicles, from accelerations over 0.1 s, or over a step if it is longer; "
             "the jolt in which a vehicle comes to rest does not count. This column and those up to "
             "`time_gap_min_s` are written only with `measure.surrogate_safety: on`",
         .value = [=](const Run& run) { return jerk(run).quantile(0.01); },
         .summary_decimals = 3},
        {.column = "jerk_p99_mps3",
         .unit = "m/s3",
         .extent = "run",
         .meaning = "99th percentile of this jerk",
         .value = [=](const Run& run) { return jerk(run).quantile(0.99); },
         .summary_decimals = 3},
        {.column = "jerk_min_mps3",
         .unit = "m/s3",
         .extent = "run",
         .meaning = "smallest (most negative) jerk",
         .value = [=](const Run& run) { return jerk(run).smallest(); },
         .summary_decimals = 3},
        {.column = "jerk_max_mps3",
         .unit = "m/s3",
         .extent = "run",
         .meaning = "largest jerk",
         .value = [=](const Run& run) { return jerk(run).largest(); },
         .summary_decimals = 3},
        {.column = "hard_braking_per_veh_km",
         .unit = "1/(veh km)",
         .extent = "run",
         .meaning = "number of times that a vehicle begins to brake harder than 3 m/s2, divided by the distance of "
                    "all vehicles; the next time counts only after the deceleration has fallen below 2 m/s2",
         .value =
             [](const Run& run) {
                 const SafetyResult& safety = run.counts().driving.safety;
                 return safety.vehicle_km > 0.0 ? static_cast<double>(safety.hard_brakings) / safety.vehicle_km : kNan;
             },
         .summary_decimals = 4}};
}

// Returns all metrics of comfort and surrogate safety.
template <class Run>
MetricList<Run> safety_metrics() {
    const auto safety = [](const Run& run) -> const SafetyResult& { return run.counts().driving.safety; };
    MetricList<Run> metrics = joined_lists<Run>(
        {comfort_metrics<Run>(),
         {{.column = "ttc_min_s",
           .unit = "s",
           .extent = "run",
           .meaning =
               "smallest time to collision (net gap divided by closing speed) of a moving vehicle that approaches its "
               "leader",
           .value = [=](const Run& run) { return safety(run).of(SafetyMeasure::time_to_collision).smallest(); },
           .summary_decimals = 3},
          {.column = "ttc_critical_percent",
           .unit = "%",
           .extent = "run",
           .meaning = "share of the time with a leader in which the time to collision is below 1.5 s",
           .value = [=](const Run& run) { return safety(run).following_percent(safety(run).critical_ttc); },
           .summary_decimals = 4},
          {.column = "ttc_short_percent",
           .unit = "%",
           .extent = "run",
           .meaning = "share of the time with a leader in which the time to collision is below 3 s",
           .value = [=](const Run& run) { return safety(run).following_percent(safety(run).short_ttc); },
           .summary_decimals = 4},
          {.column = "brake_threat_p99",
           .extent = "run",
           .meaning =
               "99th percentile of the brake threat number: the deceleration that just prevents a collision with the "
               "leader, divided by the highest one that friction allows; from 1 on, braking alone cannot prevent the "
               "collision if the leader keeps its acceleration",
           .value = [=](const Run& run) { return safety(run).of(SafetyMeasure::brake_threat).quantile(0.99); },
           .summary_decimals = 4},
          {.column = "brake_threat_max",
           .extent = "run",
           .meaning = "largest brake threat number",
           .value = [=](const Run& run) { return safety(run).of(SafetyMeasure::brake_threat).largest(); },
           .summary_decimals = 4},
          {.column = "net_gap_min_m",
           .unit = "m",
           .extent = "run",
           .meaning = "smallest net gap of a moving vehicle to its leader",
           .value = [=](const Run& run) { return safety(run).of(SafetyMeasure::net_gap).smallest(); },
           .summary_decimals = 3},
          {.column = "time_gap_min_s",
           .unit = "s",
           .extent = "run",
           .meaning = "smallest net gap divided by the speed of a vehicle faster than 5 km/h",
           .value = [=](const Run& run) { return safety(run).of(SafetyMeasure::time_gap).smallest(); },
           .summary_decimals = 3}}});
    for (Metric<Run>& metric : metrics) metric.asked_for = asks_for_safety;
    return metrics;
}

}  // namespace stopline
