#include "runs/single_light/single_light_metrics.h"

#include <deque>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "base/units.h"
#include "runs/driving/energy_metrics.h"
#include "runs/driving/safety_metrics.h"
#include "runs/metrics/metric_text.h"

namespace stopline {

namespace {

std::vector<std::string> green_numbers(const Scenario& scenario) {
    std::vector<std::string> numbers;
    for (std::size_t k = 1; k <= scenario.measure.green_s.size(); ++k) numbers.push_back(std::to_string(k));
    return numbers;
}
constexpr MetricFamily kGreens{"K", green_numbers};

// Returns true if the queue empties before the green time ends. In that case more vehicles would pass if the queue were
// longer.
bool queue_empties(const PopulationSummary& summary, double green_s) { return summary.emptied_s < green_s; }

std::string passed_text(const MeasuredGreen& run) {
    return std::to_string(run.summary.passed[run.green]) + (queue_empties(run.summary, run.green_s()) ? "*" : "");
}

std::string improvement_text(const MeasuredGreen& run) {
    const bool limited = queue_empties(run.summary, run.green_s()) || queue_empties(*run.baseline(), run.green_s());
    return MetricValue(run.summary.improvement_percent[run.green]).console_cell(0, true) + (limited ? "*" : "");
}

MetricList<MeasuredLight> passage_metrics() {
    return {{.column = "passed_in_green_veh",
             .unit = "veh",
             .extent = "green",
             .meaning = "vehicles that pass the stop line",
             .value = [](const MeasuredLight& light) { return light.summary.counter.total(); },
             .sweep_decimals = kLeftOut}};
}

MetricList<MeasuredLight> emptying_metrics() {
    return {
        {.column = "queue_emptied_s",
         .unit = "s",
         .extent = "green",
         .meaning = "time from the start of green until the last queued vehicle passes the stop line; empty: it does "
                    "not pass within the green",
         .value = [](const MeasuredLight& light) { return light.summary.emptied_s; },
         .summary_decimals = 3,
         .figure = {.axis = "time until the queue has passed",
                    .sweep = {.change = "time saved against {} [%]", .better = Better::lower}}},
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
         .console = {.heading = "headway", .decimals = 3},
         .figure = {.axis = "headway in steady state",
                    .sweep = {.change = "headway saved against {} [%]", .better = Better::lower}}},
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

bool asks_for_stability(const Scenario& scenario) { return scenario.measure.string_stability == "on"; }

MetricList<MeasuredLight> stability_metrics() {
    MetricList<MeasuredLight> metrics{
        {.column = "string_linf_ratio",
         .extent = "green",
         .meaning = "largest ratio of a vehicle's largest acceleration to that of its leader, from the start of green "
                    "on. Only vehicles that pass the stop line within the green count. Written with "
                    "`measure.string_stability: on`, as the next three columns",
         .value = [](const MeasuredLight& light) { return light.summary.stability.linf_ratio; },
         .summary_decimals = 4},
        {.column = "string_linf_from_head",
         .extent = "green",
         .meaning = "the same ratio to the first vehicle of the lane",
         .value = [](const MeasuredLight& light) { return light.summary.stability.linf_from_head; },
         .summary_decimals = 4},
        {.column = "string_gap_error_m",
         .unit = "m",
         .extent = "green",
         .meaning = "largest difference between the net gap of these vehicles and their spacing policy",
         .value = [](const MeasuredLight& light) { return light.summary.stability.gap_error_m; },
         .summary_decimals = 4},
        {.column = "string_smallest_gap_m",
         .unit = "m",
         .extent = "green",
         .meaning = "smallest net gap of these vehicles",
         .value = [](const MeasuredLight& light) { return light.summary.stability.smallest_gap_m; },
         .summary_decimals = 4}};
    for (Metric<MeasuredLight>& metric : metrics) metric.asked_for = asks_for_stability;
    return metrics;
}

}  // namespace

const MetricList<MeasuredLight>& single_light_metrics() {
    static const MetricList<MeasuredLight> kMetrics = joined_lists<MeasuredLight>(
        {passage_metrics(),
         numbered_green_metrics(green_metrics()),
         emptying_metrics(),
         steady_state_metrics(),
         stop_line_metrics(),
         queue_metrics(),
         stability_metrics(),
         count_metrics<MeasuredLight>({"vehicles_entered", "vehicles_exited", "overlaps", "red_entries",
                                       "forced_red_entries", "lost_vehicles", "state_hash"}),
         departure_metrics<MeasuredLight>(),
         {backlog_metric<MeasuredLight>()},
         energy_metrics<MeasuredLight>(),
         safety_metrics<MeasuredLight>()});
    return kMetrics;
}

MetricList<MeasuredLight> numbered_green_metrics(const MetricList<MeasuredGreen>& greens) {
    static std::deque<std::string> texts;  // what the string views of the metrics refer to
    const auto keep = [](std::string text) { return std::string_view(texts.emplace_back(std::move(text))); };
    MetricList<MeasuredLight> metrics;
    for (const Metric<MeasuredGreen>& metric : greens) {
        if (!metric.in_sweeps()) continue;
        const std::string_view name = without_unit(metric.column, metric.unit);
        metrics.push_back(
            {.column = keep(fmt::format("{}_K{}", name, metric.column.substr(name.size()))),
             .unit = metric.unit,
             .extent = metric.extent,
             .meaning = keep(with_key(metric.meaning, kThisGreen, "green time number K of `measure.green`")),
             .value =
                 [value = metric.value](const MeasuredLight& light) {
                     return value({nullptr, light.scenario, light.summary, light.key});
                 },
             .summary_decimals = kLeftOut,
             .sweep_decimals = metric.sweep_decimals,
             .has_mean = metric.has_mean,
             .family = &kGreens,
             .figure = metric.figure});
    }
    return metrics;
}

const MetricList<MeasuredGreen>& green_metrics() {
    static const MetricList<MeasuredGreen> kMetrics{
        {.column = "green_s",
         .unit = "s",
         .meaning = "green time",
         .value = [](const MeasuredGreen& run) { return run.green_s(); },
         .summary_decimals = 3,
         .sweep_decimals = kLeftOut},
        {.column = "passed_veh",
         .unit = "veh",
         .extent = "green",
         .meaning = "vehicles that pass the stop line within GREEN",
         .value = [](const MeasuredGreen& run) { return run.summary.passed[run.green]; },
         .console = {.heading = "Vehicles passed within the green time",
                     .note = "*: the queue empties before the green time ends; more demand.vehicles would raise the "
                             "count",
                     .value = passed_text},
         .figure = {.axis = "vehicles passed in green time K",
                    .sweep = {.change = "vehicles gained over {} [%]", .name = "vehicles passed in the last green"}}},
        {.column = "baseline",
         .meaning = "name of the baseline population; empty without one",
         .value = [](const MeasuredGreen& run) { return run.baseline() == nullptr ? "" : run.baseline()->name; },
         .sweep_decimals = kLeftOut},
        {.column = "baseline_passed_veh",
         .unit = "veh",
         .extent = "green",
         .meaning = "vehicles of the baseline that pass the stop line within GREEN",
         .value =
             [](const MeasuredGreen& run) {
                 return run.baseline() == nullptr ? MetricValue("") : MetricValue(run.baseline()->passed[run.green]);
             },
         .sweep_decimals = kLeftOut},
        {.column = "improvement_percent",
         .unit = "%",
         .extent = "green",
         .meaning = "gain of `passed_veh` over `baseline_passed_veh`",
         .value = [](const MeasuredGreen& run) { return run.summary.improvement_percent[run.green]; },
         .summary_decimals = 2,
         .sweep_decimals = kLeftOut,
         .console = {.heading = "improvement over BASELINE [%]", .value = improvement_text}}};
    return kMetrics;
}

std::vector<MeasuredLight> measured_runs(const SingleLightReport& report) {
    std::vector<MeasuredLight> runs;
    for (std::size_t k = 0; k < report.populations.size(); ++k) {
        runs.push_back({report.scenario, report.populations[k], report.runs[k]});
    }
    return runs;
}

std::vector<MeasuredGreen> measured_greens(const SingleLightReport& report) {
    std::vector<MeasuredGreen> runs;
    for (const PopulationSummary& summary : report.populations) {
        for (std::size_t green = 0; green < report.scenario.measure.green_s.size(); ++green) {
            runs.push_back({&report, report.scenario, summary, green});
        }
    }
    return runs;
}

}  // namespace stopline
