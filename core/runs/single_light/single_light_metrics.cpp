#include "runs/single_light/single_light_metrics.h"

#include "base/units.h"

namespace stopline {

namespace {

std::vector<std::string> green_numbers(const Scenario& scenario) {
    std::vector<std::string> numbers;
    for (std::size_t k = 1; k <= scenario.measure.green_s.size(); ++k) numbers.push_back(std::to_string(k));
    return numbers;
}
constexpr MetricFamily kGreens{"K", green_numbers};

MetricList<MeasuredLight> passage_metrics() {
    return {
        {.column = "passed_in_green_veh",
         .unit = "veh",
         .extent = "green",
         .meaning = "vehicles that pass the stop line",
         .value = [](const MeasuredLight& light) { return light.summary.counter.total(); },
         .sweep_decimals = kLeftOut},
        {.column = "passed_K_veh",
         .unit = "veh",
         .extent = "green",
         .meaning = "vehicles that pass the stop line within green time number K of `measure.green`",
         .value = [](const MeasuredLight& light) { return light.summary.passed[light.key]; },
         .summary_decimals = kLeftOut,
         .family = &kGreens},
        {.column = "queue_emptied_s",
         .unit = "s",
         .extent = "green",
         .meaning = "time from the start of green until the last queued vehicle passes the stop line; empty: it does "
                    "not pass within the green",
         .value = [](const MeasuredLight& light) { return light.summary.emptied_s; },
         .summary_decimals = 3},
    };
}

MetricList<MeasuredLight> steady_state_metrics() {
    return {
        {.column = "steady_vehicles",
         .unit = "veh",
         .extent = "green",
         .meaning = "followers in steady state downstream of the stop line: at the cruise speed for five seconds, with "
                    "a net gap that changes by 0.1 m or less and is at most 25 % and 0.5 m larger than that of the "
                    "policy. The cruise speed is that of a vehicle without leader: the speed limit in full dynamics, "
                    "and `meso.leader_speed_share` of `meso.speed_factor` times the limit in the mesoscale mode",
         .value = [](const MeasuredLight& light) { return light.summary.steady.vehicles; },
         .console = {.heading = "vehicles"}},
        {.column = "not_closed_up_vehicles",
         .unit = "veh",
         .extent = "green",
         .meaning = "followers downstream of the stop line that keep a larger net gap for five seconds, at the cruise "
                    "speed or faster. They have not reached the gap of their policy",
         .value = [](const MeasuredLight& light) { return light.summary.steady.not_closed_up; }},
        {.column = "steady_net_gap_m",
         .unit = "m",
         .extent = "green",
         .meaning = "mean net gap of these vehicles",
         .value = [](const MeasuredLight& light) { return light.summary.steady.net_gap_m; },
         .summary_decimals = 4,
         .sweep_after = "steady_headway_s",
         .console = {.heading = "net gap", .decimals = 2}},
        {.column = "policy_gap_m",
         .unit = "m",
         .meaning = "net gap of the spacing policy at the cruise speed",
         .value = [](const MeasuredLight& light) { return light.summary.steady.policy_gap_m; },
         .summary_decimals = 4,
         .sweep_decimals = kLeftOut,
         .console = {.heading = "policy", .decimals = 2}},
        {.column = "steady_headway_s",
         .unit = "s",
         .extent = "green",
         .meaning = "mean headway of these vehicles: (length + net gap) / speed",
         .value = [](const MeasuredLight& light) { return light.summary.steady.headway_s; },
         .summary_decimals = 5,
         .console = {.heading = "headway", .decimals = 3}},
        {.column = "policy_headway_s",
         .unit = "s",
         .meaning = "headway of the spacing policy at the cruise speed",
         .value = [](const MeasuredLight& light) { return light.summary.steady.policy_headway_s; },
         .summary_decimals = 5,
         .sweep_decimals = kLeftOut,
         .console = {.heading = "policy", .decimals = 3}},
        {.column = "headway_deviation_percent",
         .unit = "%",
         .extent = "green",
         .meaning = "deviation of `steady_headway_s` from `policy_headway_s`",
         .value = [](const MeasuredLight& light) { return light.summary.steady.deviation_percent; },
         .summary_decimals = 3,
         .sweep_decimals = kLeftOut,
         .console = {.heading = "deviation", .decimals = 2, .has_sign = true}},
        {.column = "asymptotic_improvement_percent",
         .unit = "%",
         .extent = "green",
         .meaning = "improvement over `measure.baseline` for very long queues, from the steady-state headways; empty "
                    "without a baseline",
         .value = [](const MeasuredLight& light) { return light.summary.asymptotic_improvement_percent; },
         .summary_decimals = 2,
         .sweep_decimals = kLeftOut,
         .console = {.heading = "gain", .decimals = 0, .has_sign = true}},
    };
}

MetricList<MeasuredLight> stop_line_metrics() {
    return {
        {.column = "last_ten_headway_s",
         .unit = "s",
         .extent = "green",
         .meaning = "mean headway at the stop line over the last ten vehicles of each lane",
         .value = [](const MeasuredLight& light) { return light.summary.last_positions.headway_s; },
         .summary_decimals = 4,
         .sweep_decimals = kLeftOut,
         .console = {.heading = "headway", .decimals = 3, .begins_part = true}},
        {.column = "last_ten_speed_mps",
         .unit = "m/s",
         .extent = "green",
         .meaning = "mean speed at the stop line over the last ten vehicles of each lane",
         .value = [](const MeasuredLight& light) { return light.summary.last_positions.speed_mps; },
         .summary_decimals = 4,
         .sweep_decimals = kLeftOut,
         .console = {.heading = "speed",
                     .decimals = 1,
                     .value =
                         [](const MeasuredLight& light) { return kKmhPerMps * light.summary.last_positions.speed_mps; },
                     .unit = "km/h"}},
        {.column = "leader_start_s",
         .unit = "s",
         .extent = "green",
         .meaning = "time from the start of green until the first vehicle moves",
         .value = [](const MeasuredLight& light) { return light.summary.leader.start_s; },
         .summary_decimals = 2,
         .sweep_decimals = kLeftOut},
        {.column = "leader_time_to_limit_s",
         .unit = "s",
         .extent = "green",
         .meaning = "time from this start until the first vehicle reaches the speed limit",
         .value = [](const MeasuredLight& light) { return light.summary.leader.duration_s(); },
         .summary_decimals = 2,
         .sweep_decimals = kLeftOut},
    };
}

MetricList<MeasuredLight> queue_metrics() {
    return {
        {.column = "queue_gap_mean_m",
         .unit = "m",
         .extent = "start of green",
         .meaning = "mean net gap in the queue",
         .value = [](const MeasuredLight& light) { return light.summary.queue.mean_m; },
         .summary_decimals = 3,
         .sweep_decimals = kLeftOut},
        {.column = "queue_gap_smallest_m",
         .unit = "m",
         .extent = "start of green",
         .meaning = "smallest net gap in the queue",
         .value = [](const MeasuredLight& light) { return light.summary.queue.smallest_m; },
         .summary_decimals = 3,
         .sweep_decimals = kLeftOut},
        {.column = "queue_gap_largest_m",
         .unit = "m",
         .extent = "start of green",
         .meaning = "largest net gap in the queue",
         .value = [](const MeasuredLight& light) { return light.summary.queue.largest_m; },
         .summary_decimals = 3,
         .sweep_decimals = kLeftOut},
    };
}

}  // namespace

const MetricList<MeasuredLight>& single_light_metrics() {
    static const MetricList<MeasuredLight> kMetrics = joined_lists<MeasuredLight>(
        {passage_metrics(), steady_state_metrics(), stop_line_metrics(), queue_metrics(),
         count_metrics<MeasuredLight>({"vehicles_entered", "vehicles_exited", "overlaps", "red_entries",
                                       "forced_red_entries", "lost_vehicles", "state_hash"})});
    return kMetrics;
}

std::vector<MeasuredLight> measured_runs(const SingleLightReport& report) {
    std::vector<MeasuredLight> runs;
    for (std::size_t k = 0; k < report.populations.size(); ++k) {
        runs.push_back({report.scenario, report.populations[k], report.runs[k]});
    }
    return runs;
}

}  // namespace stopline
